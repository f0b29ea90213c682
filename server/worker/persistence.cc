#include "server/worker/persistence.h"

#include <algorithm>
#include <random>

#include "absl/time/clock.h"

namespace poise::worker {

absl::Duration Pauses::Next() {
  // Not reproducible on purpose: workers must differ.
  thread_local std::mt19937_64 engine{std::random_device()()};
  const double share = std::uniform_real_distribution<double>(0.5, 1.0)(engine);
  const absl::Duration pause = pause_ * share;
  pause_ = std::min(2 * pause_, config_.longest_pause);
  return pause;
}

void PauseUnless(const std::function<bool()>& give_up, absl::Duration pause) {
  constexpr absl::Duration kLook = absl::Milliseconds(50);
  for (; pause > absl::ZeroDuration() && !give_up(); pause -= kLook) {
    absl::SleepFor(std::min(pause, kLook));
  }
}

}  // namespace poise::worker
