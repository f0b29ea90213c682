#ifndef POISE_CORE_ENGINE_JOB_COUNTERS_H_
#define POISE_CORE_ENGINE_JOB_COUNTERS_H_

#include <mutex>
#include <set>
#include <string>

#include "core/base/telemetry.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::engine {

/// What is measured of jobs. The counters follow the commits of this process, the gauges what the
/// store holds, so that over the life of a process
///   submitted - deleted = the change of the sum of poise_jobs.
/// Threads: all members may be called from any thread.
class JobCounters {
 public:
  explicit JobCounters(base::Telemetry& telemetry);

  void Count(const jobs::Transition& transition);
  void CountDeleted(int64_t jobs);
  void Show(const jobs::StoreStats& stats, size_t workers);

 private:
  // Reasons come from workers too; a counter for each invented one would fill the memory.
  static constexpr size_t kMaxReasons = 200;
  std::string ReasonLabel(const jobs::Transition& transition);

  base::Telemetry& telemetry_;
  base::Counter& deleted_;
  base::Histogram& queue_seconds_;
  base::Histogram& run_seconds_;
  base::Gauge& oldest_queued_;
  base::Gauge& leases_;
  base::Gauge& workers_;
  base::Gauge& store_bytes_;
  base::Gauge& log_bytes_;

  std::mutex mutex_;
  std::set<std::string> reasons_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_COUNTERS_H_
