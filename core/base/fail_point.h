#ifndef POISE_CORE_BASE_FAIL_POINT_H_
#define POISE_CORE_BASE_FAIL_POINT_H_

#include <atomic>
#include <functional>
#include <string>

namespace poise::base {

namespace internal {
extern std::atomic<int> active_fail_points;
void HitFailPoint(const char* name);
}  // namespace internal

/// A named place at which a test may hold or end the program, to make a race or a crash happen at
/// will: FailPoint("sqlite.after_commit"). Costs one load of a flag while none is set.
/// Threads: any.
inline void FailPoint(const char* name) {
  if (internal::active_fail_points.load(std::memory_order_relaxed) > 0) {
    internal::HitFailPoint(name);
  }
}

/// Runs `action` whenever `name` is hit, on the thread that hits it; an empty one takes it away.
void SetFailPoint(const std::string& name, std::function<void()> action);

/// From the environment, for tests with real processes: POISE_FAIL_POINTS="NAME=ACTION,..." with
/// the actions kill, kill:N (at the Nth hit) and sleep:MILLISECONDS. Called first thing in main.
void SetFailPointsFromEnvironment();

}  // namespace poise::base

#endif  // POISE_CORE_BASE_FAIL_POINT_H_
