#include "core/runtime/jobs/deadline_runner.h"

#include <algorithm>

#include "absl/time/clock.h"

namespace poise::jobs {

StatusOr<RunOutput> DeadlineRunner::Run(const RunInput& input, const JobContext& context) {
  if (left_ == absl::InfiniteDuration()) return inner_->Run(input, context);
  JobContext limited = context;
  const absl::Time deadline = absl::Now() + left_;
  limited.run.deadline = std::min(context.run.deadline, deadline);
  StatusOr<RunOutput> output = inner_->Run(input, limited);
  // Somebody who asked to stop before learns that it stopped.
  const bool asked = context.run.cancellation.cancelled();
  if (output.ok() || asked || absl::Now() <= deadline) return output;
  return base::MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED",
                         "limits.deadline", "the job's deadline passed while it ran");
}

}  // namespace poise::jobs
