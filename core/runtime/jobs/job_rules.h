#ifndef POISE_CORE_RUNTIME_JOBS_JOB_RULES_H_
#define POISE_CORE_RUNTIME_JOBS_JOB_RULES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/runtime/jobs/job_store.h"

/// What every store decides in the same way: pure functions, without a database.
namespace poise::jobs {

/// Whether another attempt may cure an error with this code.
bool IsRetryable(absl::StatusCode code);

/// The pause before the next attempt: drawn from (0, first_backoff * 2^(errors - 1)], the upper end
/// at most max_backoff. The same for the same job and number of errors.
absl::Duration RetryDelay(const JobPolicy& policy, std::string_view job, int errors);

/// Sorts the waiting jobs of a tenant, smallest first [ms]. A priority counts as much as having
/// waited `age_step` longer, so a job is overtaken only by those of higher priority that came less
/// than that after it.
int64_t ClaimKey(const JobPolicy& policy, absl::Time create_time, int priority);

/// What an attempt's end depends on.
struct AttemptEnd {
  std::string_view job;  ///< id
  api::AttemptOutcome outcome = api::AttemptOutcome::kSucceeded;
  std::optional<api::JobError> error;
  int errors = 0;  ///< before this end
  int losses = 0;
  api::JobLimits limits;
  std::optional<std::string> cancelled_by;  ///< somebody wished the job to be cancelled
};

/// And what it leads to.
struct EndDecision {
  api::JobState state{};                            ///< kQueued, kSucceeded, kFailed or kCancelled
  std::optional<api::JobError> error = {};          ///< of the job
  std::optional<api::JobError> attempt_error = {};  ///< of the attempt
  int errors = 0;
  int losses = 0;
  absl::Duration retry_delay = {};  ///< with kQueued
};

/// Success stands. Otherwise a wish to cancel wins. An error that a retry may cure, and a stall,
/// cost one of max_errors; a loss costs one of max_losses; giving back costs nothing; any other
/// error ends the job.
EndDecision DecideEnd(const JobPolicy& policy, const AttemptEnd& end);

/// The errors that the store itself gives to attempts and jobs.
api::JobError CancelledBy(std::string_view who);
api::JobError WorkerLost(std::string_view worker);
api::JobError DeadlinePassed(const api::JobLimits& limits);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_JOB_RULES_H_
