#ifndef POISE_CORE_RUNTIME_JOBS_DEADLINE_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_DEADLINE_RUNNER_H_

#include <memory>

#include "absl/time/time.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// Stops an attempt when the job's deadline passes: from then on RunContext::Check tells it so. An
/// attempt that ends without success afterwards has failed with kDeadlineExceeded
/// DEADLINE_EXCEEDED (field "limits.deadline"), whatever it says itself; success stands.
class DeadlineRunner : public JobRunner {
 public:
  /// `left` counts from the start of Run; infinite: none.
  DeadlineRunner(std::unique_ptr<JobRunner> inner, absl::Duration left)
      : inner_(std::move(inner)), left_(left) {}

  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;

 private:
  const std::unique_ptr<JobRunner> inner_;
  const absl::Duration left_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_DEADLINE_RUNNER_H_
