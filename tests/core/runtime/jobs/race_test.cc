#include <tuple>

#include "tests/core/runtime/jobs/race_scenarios.h"

// Every race, directed: one side is held just before it takes effect, the other goes first.
// unfenced_store_test shows that these scenarios notice a store whose fence has a hole.
namespace poise::testing {
namespace {

class RaceTest : public ::testing::TestWithParam<std::tuple<StoreKind, RaceScenario>> {};

TEST_P(RaceTest, IsDecidedOnceAndForTheRightSide) {
  const auto& [kind, scenario] = GetParam();
  const TemporaryFolder folder;
  TestClock clock;
  const auto store = kind.open(folder.path(), {}, [&] { return clock.Now(); });
  ASSERT_TRUE(store.ok()) << store.status();
  RaceStage stage(**store, clock, {});
  scenario.run(stage);
  EXPECT_THAT(stage.broken(), ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Stores, RaceTest,
                         ::testing::Combine(::testing::ValuesIn(StoreKinds()),
                                            ::testing::ValuesIn(RaceScenarios())),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + "_" +
                                  std::get<1>(info.param).name;
                         });

}  // namespace
}  // namespace poise::testing
