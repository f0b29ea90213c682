#ifndef POISE_CORE_RUNTIME_JOBS_COUNTING_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_COUNTING_RUNNER_H_

#include <memory>

#include "core/base/telemetry.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// Counts attempts: poise_worker_attempts_running, poise_worker_attempts_total{kind,code,reason}
/// (of an attempt that succeeded code and reason are OK) and poise_worker_attempt_seconds{kind}.
class CountingRunner : public JobRunner {
 public:
  /// `telemetry` outlives it.
  CountingRunner(std::unique_ptr<JobRunner> inner, base::Telemetry& telemetry)
      : inner_(std::move(inner)), telemetry_(telemetry) {}

  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;

 private:
  const std::unique_ptr<JobRunner> inner_;
  base::Telemetry& telemetry_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_COUNTING_RUNNER_H_
