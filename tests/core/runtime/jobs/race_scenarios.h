#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_RACE_SCENARIOS_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_RACE_SCENARIOS_H_

#include <vector>

#include "tests/core/runtime/jobs/race_stage.h"

namespace poise::testing {

/// What in the fence the outcome of a race hangs on: a store without it breaks a promise there.
enum class Guard {
  kNone,            ///< on nothing in the fence
  kAttemptOrToken,  ///< one of them is enough
  kAttempt,
  kToken,
};

/// A race in which one side is held at a fail-point while the other goes first.
struct RaceScenario {
  const char* name;
  Guard guard;
  void (*run)(RaceStage&);
};
inline void PrintTo(const RaceScenario& scenario, std::ostream* out) { *out << scenario.name; }

/// Calls of a worker whose attempt is over, or that never had it.
const std::vector<RaceScenario>& StaleCallScenarios();
/// Two calls that both may come, in either order.
const std::vector<RaceScenario>& OrderScenarios();
/// All of them.
std::vector<RaceScenario> RaceScenarios();

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_RACE_SCENARIOS_H_
