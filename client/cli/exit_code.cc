#include "client/cli/exit_code.h"

namespace poise::cli {

bool IsJobOutcome(const Status& status) {
  const std::string reason = base::ErrorReason(status);
  return reason == kJobFailedReason || reason == kJobCancelledReason;
}

ExitCode ExitCodeOf(const Status& status) {
  if (base::ErrorReason(status) == kJobFailedReason) return ExitCode::kJobFailed;
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return ExitCode::kOk;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
      return ExitCode::kInvalidArgument;
    case absl::StatusCode::kNotFound:
      return ExitCode::kNotFound;
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kAborted:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kUnauthenticated:
      return ExitCode::kFailedPrecondition;
    case absl::StatusCode::kUnavailable:
      return ExitCode::kUnavailable;
    case absl::StatusCode::kCancelled:
    case absl::StatusCode::kDeadlineExceeded:
      return ExitCode::kStopped;
    case absl::StatusCode::kResourceExhausted:
      return ExitCode::kResourceExhausted;
    default:
      return ExitCode::kInternal;
  }
}

}  // namespace poise::cli
