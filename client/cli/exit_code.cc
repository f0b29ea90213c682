#include "client/cli/exit_code.h"

namespace poise::cli {

bool IsJobOutcome(const Status& status) {
  const std::string reason = base::ErrorReason(status);
  return reason == kJobFailedReason || reason == kJobCancelledReason;
}

ExitCode ExitCodeOf(const Status& status) {
  if (base::ErrorReason(status) == kJobFailedReason) return ExitCode::kJobFailed;
  return base::ExitCodeOf(status);
}

}  // namespace poise::cli
