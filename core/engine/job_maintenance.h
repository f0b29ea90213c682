#ifndef POISE_CORE_ENGINE_JOB_MAINTENANCE_H_
#define POISE_CORE_ENGINE_JOB_MAINTENANCE_H_

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "absl/time/time.h"
#include "core/base/random.h"
#include "core/base/status.h"
#include "core/engine/job_log.h"

namespace poise::engine {

/// What is done to keep jobs healthy, again and again.
struct RepeatedTask {
  std::string name;
  absl::Duration interval;  ///< [> 0] give or take a quarter, so that servers do not fall in step
  std::function<Status()> run;
  absl::Duration delay = absl::ZeroDuration();  ///< before the first run
};

/// One thread that runs the repeated tasks, and what is to be done once at a certain time. A task
/// that fails is told to the log, at most once a second, and tried again at its next turn.
/// Threads: all members may be called from any thread.
class JobMaintenance {
 public:
  explicit JobMaintenance(JobLog& log);
  ~JobMaintenance() { Stop(); }
  JobMaintenance(const JobMaintenance&) = delete;
  JobMaintenance& operator=(const JobMaintenance&) = delete;

  void Start(std::vector<RepeatedTask> tasks);
  /// Waits for the task that runs; no other begins.
  void Stop();

  void RunAt(absl::Time time, std::function<void()> action);

 private:
  struct Repeated {
    RepeatedTask task;
    absl::Time next;
  };

  void Loop();
  void RunDue(std::unique_lock<std::mutex>& lock);
  void RunTask(Repeated& repeated);
  absl::Time NextTime() const;

  JobLog& log_;
  std::vector<Repeated> repeated_;
  base::Random random_;
  absl::Time last_complaint_ = absl::InfinitePast();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::multimap<absl::Time, std::function<void()>> once_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_MAINTENANCE_H_
