#include <cstdlib>
#include <memory>

#include "absl/time/clock.h"
#include "tests/core/runtime/jobs/random_caller.h"

// Eight threads call at random, and a model in memory checks what comes of it: no order of calls
// may break what a job promises. POISE_TEST_SEED and POISE_TEST_SECONDS change the run.
namespace poise::testing {
namespace {

constexpr int kThreads = 8;
constexpr int kDefaultSeconds = 8;

int64_t NumberFromEnvironment(const char* name, int64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

class RandomCallsTest : public JobStoreTest {
 protected:
  // Until nothing waits and nothing runs.
  void EndEverything(JobModel& model) {
    for (;;) {
      clock_.Advance(policy_.max_backoff);
      Reap();
      int started = 0;
      while (const auto lease = TryClaim("last")) {
        model.OnClaimed(lease->fence);
        if (Finish(*lease, Success()) == api::JobState::kSucceeded) model.OnSuccess(lease->fence);
        ++started;
      }
      if (started == 0 && store().Stats()->jobs["default"][api::JobState::kQueued] == 0) return;
    }
  }
};

TEST_P(RandomCallsTest, NoOrderOfCallsBreaksAPromise) {
  const auto seed = static_cast<uint64_t>(NumberFromEnvironment("POISE_TEST_SEED", 1));
  const absl::Time end =
      absl::Now() + absl::Seconds(NumberFromEnvironment("POISE_TEST_SECONDS", kDefaultSeconds));
  JobModel model;
  store().SetListener(
      {.on_transition = [&](const jobs::Transition& change) { model.OnTransition(change); },
       .on_event = nullptr});
  std::atomic<int64_t> calls = 0;
  std::atomic<int64_t> refused = 0;
  InParallel(kThreads, [&](int i) {
    RandomCaller caller(store(), clock_, policy_, model, i, seed);
    while (absl::Now() < end) {
      caller.CallOnce();
      ++calls;
    }
    refused += caller.lease_lost();
  });
  EndEverything(model);
  model.CheckAtTheEnd(store());
  EXPECT_THAT(model.faults(), ::testing::IsEmpty()) << "seed " << seed;
  EXPECT_GT(refused, 0) << "stale workers took part";
  ExpectSound();
  std::cout << "seed " << seed << ": " << calls << " calls, " << model.jobs() << " jobs, "
            << model.transitions() << " changes of state, " << refused << " stale calls refused\n";
  store().SetListener({});
}

INSTANTIATE_TEST_SUITE_P(Stores, RandomCallsTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
