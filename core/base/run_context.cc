#include "core/base/run_context.h"

#include "absl/time/clock.h"

namespace poise::base {

Status RunContext::Check() const {
  if (cancellation.cancelled()) {
    return MakeError(absl::StatusCode::kCancelled, "CANCELLED", "",
                     "the caller cancelled the work");
  }
  if (deadline != absl::InfiniteFuture() && absl::Now() > deadline) {
    return MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
                     "the deadline passed before the work was done");
  }
  return absl::OkStatus();
}

}  // namespace poise::base
