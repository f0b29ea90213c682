#include "tests/core/runtime/jobs/race_scenarios.h"

namespace poise::testing {

std::vector<RaceScenario> RaceScenarios() {
  std::vector<RaceScenario> scenarios = StaleCallScenarios();
  scenarios.insert(scenarios.end(), OrderScenarios().begin(), OrderScenarios().end());
  return scenarios;
}

}  // namespace poise::testing
