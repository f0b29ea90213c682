#include "core/runtime/jobs/sqlite_fence.h"
#include "tests/core/runtime/jobs/race_scenarios.h"

// The SQLite store with holes in its fence, which the linker puts in the place of the true one: the
// directed races must notice each of them every time. Random chaos does not.
namespace poise::jobs::sqlite {
namespace {

std::string_view condition;

}  // namespace

std::string_view FenceCondition() { return condition; }

}  // namespace poise::jobs::sqlite

namespace poise::testing {
namespace {

constexpr int kRepeats = 20;

struct Hole {
  const char* name;
  const char* condition;
  // Whether a race that hangs on this guard goes wrong.
  bool (*breaks)(Guard);
};

constexpr Hole kHoles[] = {
    {"NoFence", "job = (SELECT number FROM jobs WHERE id = ?1) AND ?2 > 0 AND ?3 <> ''",
     [](Guard guard) { return guard != Guard::kNone; }},
    {"NoAttempt", "job = (SELECT number FROM jobs WHERE id = ?1) AND ?2 > 0 AND token_hash = ?3",
     [](Guard guard) { return guard == Guard::kAttempt; }},
    {"NoToken", "job = (SELECT number FROM jobs WHERE id = ?1) AND attempt = ?2 AND ?3 <> ''",
     [](Guard guard) { return guard == Guard::kToken; }},
};
constexpr const char* kWhole =
    "job = (SELECT number FROM jobs WHERE id = ?1) AND attempt = ?2 AND token_hash = ?3";

// How many of `repeats` runs broke a promise.
int BrokenRuns(const RaceScenario& scenario, int repeats) {
  int broken = 0;
  for (int i = 0; i < repeats; ++i) {
    const TemporaryFolder folder;
    TestClock clock;
    const auto store = StoreKinds().front().open(folder.path(), {}, [&] { return clock.Now(); });
    EXPECT_TRUE(store.ok()) << store.status();
    RaceStage stage(**store, clock, {});
    scenario.run(stage);
    broken += !stage.broken().empty();
  }
  return broken;
}

class UnfencedStoreTest : public ::testing::TestWithParam<Hole> {};

TEST_P(UnfencedStoreTest, IsNoticedByEveryRaceThatHangsOnIt) {
  jobs::sqlite::condition = GetParam().condition;
  int noticed_by = 0;
  for (const RaceScenario& scenario : RaceScenarios()) {
    const bool breaks = GetParam().breaks(scenario.guard);
    const int repeats = breaks ? kRepeats : 1;
    const int broken = BrokenRuns(scenario, repeats);
    EXPECT_EQ(broken, breaks ? repeats : 0) << scenario.name;
    if (!breaks) continue;
    ++noticed_by;
    std::cout << scenario.name << " noticed it " << broken << " of " << repeats << " times\n";
  }
  EXPECT_GT(noticed_by, 0);
}

INSTANTIATE_TEST_SUITE_P(Holes, UnfencedStoreTest, ::testing::ValuesIn(kHoles),
                         [](const auto& info) { return info.param.name; });

TEST(WholeFenceTest, BreaksNoPromise) {
  jobs::sqlite::condition = kWhole;
  for (const RaceScenario& scenario : RaceScenarios()) EXPECT_EQ(BrokenRuns(scenario, 1), 0);
}

}  // namespace
}  // namespace poise::testing
