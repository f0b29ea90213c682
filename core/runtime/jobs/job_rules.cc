#include "core/runtime/jobs/job_rules.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/random.h"

namespace poise::jobs {
namespace {

using api::AttemptOutcome;
using api::JobError;
using api::JobState;

// FNV-1a: the same on every machine, unlike std::hash.
uint64_t Hash(std::string_view text) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ULL;
  return hash;
}

// The error that an attempt ended with, when its worker gave none.
JobError ErrorOf(const AttemptEnd& end) {
  if (end.error) return *end.error;
  switch (end.outcome) {
    case AttemptOutcome::kStalled:
      return {
          .code = absl::StatusCode::kUnavailable,
          .reason = "STALLED",
          .message = fmt::format("no step for {}", absl::FormatDuration(end.limits.stall_timeout)),
          .field = ""};
    case AttemptOutcome::kLost:
      return {.code = absl::StatusCode::kUnavailable,
              .reason = "PROCESS_LOST",
              .message = "the process of the attempt vanished",
              .field = ""};
    case AttemptOutcome::kCancelled:
      if (end.cancelled_by) return CancelledBy(*end.cancelled_by);
      return {.code = absl::StatusCode::kCancelled,
              .reason = "CANCELLED",
              .message = "the worker stopped the attempt, which nobody had asked for",
              .field = ""};
    default:
      return {.code = absl::StatusCode::kUnknown,
              .reason = "UNKNOWN",
              .message = "the worker told no error",
              .field = ""};
  }
}

}  // namespace

bool IsRetryable(absl::StatusCode code) {
  return code == absl::StatusCode::kUnavailable || code == absl::StatusCode::kAborted ||
         code == absl::StatusCode::kResourceExhausted;
}

absl::Duration RetryDelay(const JobPolicy& policy, std::string_view job, int errors) {
  absl::Duration limit = policy.first_backoff;
  for (int doubled = 1; doubled < errors && limit < policy.max_backoff; ++doubled) limit *= 2;
  limit = std::min(limit, policy.max_backoff);
  base::Random random(base::DeriveSeed(Hash(job), {static_cast<uint64_t>(errors)}));
  return limit * (1.0 - random.Uniform());
}

int64_t ClaimKey(const JobPolicy& policy, absl::Time create_time, int priority) {
  constexpr absl::Duration kLongest = absl::Hours(24 * 3650);  // keeps the product in range
  const absl::Duration step = std::clamp(policy.age_step, absl::Milliseconds(1), kLongest);
  return absl::ToUnixMillis(create_time) - priority * absl::ToInt64Milliseconds(step);
}

EndDecision DecideEnd(const JobPolicy& policy, const AttemptEnd& end) {
  EndDecision decision{.errors = end.errors, .losses = end.losses};
  if (end.outcome == AttemptOutcome::kSucceeded) {
    decision.state = JobState::kSucceeded;
    return decision;
  }
  const bool lost = end.outcome == AttemptOutcome::kLost;
  const bool released = end.outcome == AttemptOutcome::kReleased;
  if (!released) decision.attempt_error = ErrorOf(end);
  decision.error = decision.attempt_error;
  const bool retryable =
      end.outcome == AttemptOutcome::kStalled ||
      (end.outcome == AttemptOutcome::kError && IsRetryable(decision.attempt_error->code));
  if (lost) ++decision.losses;
  if (retryable) ++decision.errors;

  if (end.cancelled_by) {
    decision.state = JobState::kCancelled;
    decision.error = CancelledBy(*end.cancelled_by);
  } else if (released || (lost && decision.losses < end.limits.max_losses)) {
    decision.state = JobState::kQueued;
  } else if (retryable && decision.errors < end.limits.max_errors) {
    decision.state = JobState::kQueued;
    decision.retry_delay = RetryDelay(policy, end.job, decision.errors);
  } else {
    decision.state = JobState::kFailed;
  }
  return decision;
}

JobError CancelledBy(std::string_view who) {
  return {.code = absl::StatusCode::kCancelled,
          .reason = "CANCELLED",
          .message = fmt::format("cancelled by {}", who.empty() ? "somebody" : who),
          .field = ""};
}

JobError WorkerLost(std::string_view worker) {
  return {.code = absl::StatusCode::kUnavailable,
          .reason = "WORKER_LOST",
          .message = fmt::format("worker {} was not heard of within its lease", worker),
          .field = ""};
}

JobError DeadlinePassed(const api::JobLimits& limits) {
  return {.code = absl::StatusCode::kDeadlineExceeded,
          .reason = "DEADLINE_EXCEEDED",
          .message = fmt::format("not done within its deadline of {}",
                                 absl::FormatDuration(limits.deadline)),
          .field = "limits.deadline"};
}

}  // namespace poise::jobs
