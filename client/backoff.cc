#include "client/backoff.h"

#include <algorithm>
#include <random>

#include "absl/time/clock.h"

namespace poise::client {
namespace {

// Waits need no seed that a user could give: they change no result.
double UpperHalf() {
  static thread_local std::mt19937 engine{std::random_device()()};
  return std::uniform_real_distribution<double>(0.5, 1)(engine);
}

}  // namespace

bool IsTransient(const Status& status) {
  return status.code() == absl::StatusCode::kUnavailable ||
         (status.code() == absl::StatusCode::kResourceExhausted &&
          base::RetryDelay(status).has_value());
}

std::optional<absl::Duration> Backoff::Next(const Status& failure) {
  if (!IsTransient(failure)) return std::nullopt;
  const absl::Time now = absl::Now();
  outage_begin_ = std::min(outage_begin_, now);
  const absl::Duration delay =
      std::max(delay_ * UpperHalf(), base::RetryDelay(failure).value_or(absl::ZeroDuration()));
  if (now + delay - outage_begin_ > config_.outage) return std::nullopt;
  delay_ = std::min(delay_ * 2, config_.longest);
  return delay;
}

void Backoff::NoteProgress() {
  NoteAnswer();
  delay_ = config_.first;
}

}  // namespace poise::client
