#include <fmt/format.h>

#include <map>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// Who is next: no tenant starves another, then priority, then age.
namespace poise::testing {
namespace {

class ClaimOrderTest : public JobStoreTest {
 protected:
  std::string SubmitWith(int priority, const std::string& queue = "default",
                         const std::string& kind = "selftest") {
    jobs::NewJob request = Request();
    request.request.priority = priority;
    request.request.queue = queue;
    request.request.spec.kind = kind;
    return Submit(request);
  }
  std::string TenantOf(const jobs::Lease& lease) {
    for (const jobs::Transition& change : Transitions()) {
      if (change.job == lease.fence.job) return change.tenant;
    }
    return "";
  }
  // One tenant has queued thousands of jobs when another comes with five.
  void ExpectLateTenantIsNext(int slots) {
    SubmitMany(RequestOf("many"), 5000);
    std::vector<jobs::Lease> running;
    for (int i = 0; i < slots; ++i) running.push_back(Claim());
    SubmitMany(RequestOf("few"), 5);
    Finish(running.front(), Success());
    EXPECT_EQ(TenantOf(Claim()), "few") << "the first slot that is free is its";
  }
  // Lets `slots` workers run `count` jobs, each as long as the others; how many each tenant got.
  std::map<std::string, int> Run(int slots, int count) {
    std::map<std::string, int> started;
    std::vector<jobs::Lease> running;
    for (int i = 0; i < count; ++i) {
      if (running.size() == static_cast<size_t>(slots)) {
        Finish(running.front(), Success());
        running.erase(running.begin());
      }
      running.push_back(Claim());
      ++started[TenantOf(running.back())];
    }
    for (const jobs::Lease& lease : running) Finish(lease, Success());
    return started;
  }
};

TEST_P(ClaimOrderTest, OldestFirst) {
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back(Submit());  // within one millisecond: in the order of arrival
  }
  for (const std::string& id : ids) EXPECT_EQ(Claim().fence.job, id);
}

TEST_P(ClaimOrderTest, AHigherPriorityGoesFirst) {
  const std::string low = SubmitWith(-1);
  clock_.Advance(absl::Seconds(1));
  const std::string middle = SubmitWith(0);
  clock_.Advance(absl::Seconds(1));
  const std::string high = SubmitWith(10);
  EXPECT_EQ(Claim().fence.job, high);
  EXPECT_EQ(Claim().fence.job, middle);
  EXPECT_EQ(Claim().fence.job, low);
}

TEST_P(ClaimOrderTest, WaitingLongLiftsAJobAboveThoseThatCameMuchLater) {
  policy_.age_step = absl::Minutes(10);
  const std::string old = SubmitWith(0);
  clock_.Advance(absl::Minutes(10) - absl::Milliseconds(1));
  const std::string soon = SubmitWith(1);
  clock_.Advance(absl::Milliseconds(2));
  const std::string late = SubmitWith(1);
  EXPECT_EQ(Claim().fence.job, soon) << "less than a step after it";
  EXPECT_EQ(Claim().fence.job, old);
  EXPECT_EQ(Claim().fence.job, late);
}

TEST_P(ClaimOrderTest, ANewAgeStepSortsTheWaitingJobsAnew) {
  policy_.age_step = absl::Minutes(10);
  const std::string old = SubmitWith(0);
  clock_.Advance(absl::Minutes(5));
  const std::string high = SubmitWith(1);
  CloseStore();
  policy_.age_step = absl::Minutes(1);
  EXPECT_EQ(Claim().fence.job, old);
  EXPECT_EQ(Claim().fence.job, high);
}

TEST_P(ClaimOrderTest, AWorkerGetsOnlyItsQueuesAndKinds) {
  const std::string a1 = SubmitWith(0, "a", "one");
  const std::string b1 = SubmitWith(5, "b", "one");
  const std::string b2 = SubmitWith(9, "b", "two");
  const auto claim = [&](std::vector<std::string> queues, std::vector<std::string> kinds) {
    const auto lease = TryClaim("w", {"", "", std::move(queues), std::move(kinds)});
    return lease ? lease->fence.job : "none";
  };
  EXPECT_EQ(claim({"c"}, {}), "none");
  EXPECT_EQ(claim({}, {"three"}), "none");
  EXPECT_EQ(claim({"a"}, {"two"}), "none");
  EXPECT_EQ(claim({"b"}, {"one", "three"}), b1);
  EXPECT_EQ(claim({"a", "c"}, {}), a1);
  EXPECT_EQ(claim({}, {"one"}), "none");
  EXPECT_EQ(claim({"a", "b"}, {"one", "two"}), b2);
}

TEST_P(ClaimOrderTest, TheBestOfSeveralQueuesAndKindsIsNext) {
  const std::string low = SubmitWith(0, "a", "one");
  const std::string high = SubmitWith(5, "b", "two");
  const auto lease = TryClaim("w", {"", "", {"a", "b"}, {"one", "two"}});
  ASSERT_TRUE(lease.has_value());
  EXPECT_EQ(lease->fence.job, high);
  EXPECT_EQ(Claim().fence.job, low);
}

TEST_P(ClaimOrderTest, ATenantThatComesLateStartsWithinOneJob) { ExpectLateTenantIsNext(4); }

TEST_P(ClaimOrderTest, ATenantThatComesLateStartsWithinOneJobOfTheOnlyWorker) {
  ExpectLateTenantIsNext(1);
}

TEST_P(ClaimOrderTest, TenantsOfOneWorkerTakeTurns) {
  SubmitMany(RequestOf("a"), 20);
  SubmitMany(RequestOf("b"), 20);
  EXPECT_EQ(Run(1, 10), (std::map<std::string, int>{{"a", 5}, {"b", 5}}));
  SubmitMany(RequestOf("c"), 20);
  EXPECT_EQ(Run(1, 12), (std::map<std::string, int>{{"a", 4}, {"b", 4}, {"c", 4}}))
      << "who comes late has saved nothing up";
}

TEST_P(ClaimOrderTest, RunningJobsFollowTheWeights) {
  policy_.tenant_weights = {{"heavy", 3}};
  SubmitMany(RequestOf("light"), 200);
  SubmitMany(RequestOf("heavy"), 200);
  std::map<std::string, int> running;
  for (int i = 0; i < 80; ++i) ++running[TenantOf(Claim())];
  EXPECT_NEAR(running.at("heavy"), 60, 6);
  EXPECT_NEAR(running.at("light"), 20, 2);
}

TEST_P(ClaimOrderTest, StartedJobsFollowTheWeightsHoweverFewRunAtOnce) {
  policy_.tenant_weights = {{"heavy", 3}};
  SubmitMany(RequestOf("light"), 200);
  SubmitMany(RequestOf("heavy"), 400);
  for (const int slots : {1, 4, 20}) {
    const auto started = Run(slots, 100);
    EXPECT_NEAR(started.at("heavy"), 75, 7.5) << slots << " slots";
    EXPECT_NEAR(started.at("light"), 25, 2.5) << slots << " slots";
  }
}

TEST_P(ClaimOrderTest, ATenantOfNoWeightRunsWhenNobodyElseWantsTo) {
  policy_.tenant_weights = {{"idle", 0}};
  Submit(RequestOf("idle"));
  Submit(RequestOf("idle"));
  Claim();
  SubmitMany(RequestOf("other"), 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(TenantOf(Claim()), "other");
  EXPECT_EQ(TenantOf(Claim()), "idle");
}

INSTANTIATE_TEST_SUITE_P(Stores, ClaimOrderTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
