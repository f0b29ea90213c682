#include <atomic>
#include <thread>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// What operators rely on: old jobs go, the numbers add up, and a backup is a whole store.
namespace poise::testing {
namespace {

using api::JobState;
using ::testing::Contains;
using ::testing::Field;
using ::testing::Not;
using ::testing::SizeIs;

class UpkeepTest : public JobStoreTest {
 protected:
  int64_t Collect() {
    const auto collected = store().CollectExpired();
    EXPECT_TRUE(collected.ok()) << collected.status();
    return collected.value_or(-1);
  }
};

TEST_P(UpkeepTest, EndedJobsGoWhenTheirTimeIsOver) {
  policy_.retention = absl::Hours(2);
  const std::string ended = RunJob(Success());
  const std::string waits = Submit();
  EXPECT_EQ(Get(ended).expire_time, clock_.Now() + absl::Hours(2));
  clock_.Advance(absl::Hours(2) - absl::Milliseconds(1));
  EXPECT_EQ(Collect(), 0);
  clock_.Advance(absl::Milliseconds(1));
  EXPECT_EQ(Collect(), 1);
  EXPECT_EQ(ReasonOf(store().Get("default", ended)), "JOB_NOT_FOUND");
  EXPECT_EQ(ReasonOf(store().ReadEvents(ended, 0, 1)), "JOB_NOT_FOUND");
  EXPECT_EQ(Get(waits).state, JobState::kQueued);
  EXPECT_EQ(store().Stats()->deleted, 1);
  EXPECT_EQ(store().Stats()->events, 1) << "only those of the other job";
  ExpectSound();
}

TEST_P(UpkeepTest, ManyExpiredJobsGoInOneCall) {
  policy_.retention = absl::Hours(1);
  SubmitMany(Request(), 250);
  while (const auto lease = TryClaim()) Finish(*lease, Success());
  clock_.Advance(absl::Hours(1));
  EXPECT_EQ(Collect(), 250);
  EXPECT_EQ(store().Stats()->events, 0);
}

TEST_P(UpkeepTest, ADeletedJobIsGoneWithAllThatBelongedToIt) {
  const std::string id = RunJob(Success());
  EXPECT_TRUE(store().Delete("default", id).ok());
  EXPECT_EQ(ReasonOf(store().Delete("default", id)), "JOB_NOT_FOUND");
  const jobs::StoreStats stats = *store().Stats();
  EXPECT_EQ(stats.events, 0);
  EXPECT_EQ(stats.submitted, 1);
  EXPECT_EQ(stats.deleted, 1);
  ExpectSound();
}

TEST_P(UpkeepTest, TheNumbersAddUp) {
  RunJob(ErrorWith(absl::StatusCode::kInternal));
  EXPECT_TRUE(store().Delete("default", RunJob(Success())).ok());
  Submit();
  Cancel(Claim().fence.job);
  for (int i = 0; i < 2; ++i) Submit(RequestOf("other"));

  const jobs::StoreStats stats = *store().Stats();
  int64_t there = 0;
  for (const auto& [tenant, states] : stats.jobs) {
    EXPECT_THAT(states, SizeIs(6)) << "all states of " << tenant;
    for (const auto& [state, count] : states) {
      there += count;
      jobs::ListQuery query{.tenant = tenant, .page_size = 1000};
      query.filter.state = state;
      EXPECT_EQ(store().List(query)->jobs.size(), count)
          << tenant << " " << api::JobStateName(state);
    }
  }
  EXPECT_EQ(stats.submitted, there + stats.deleted);
  EXPECT_EQ(stats.submitted, 5);
  EXPECT_EQ(stats.leases, 1);
  int64_t created = 0;
  for (const jobs::Transition& change : Transitions()) created += !change.from.has_value();
  EXPECT_EQ(created, stats.submitted);
}

TEST_P(UpkeepTest, TimeInQueueAndTimeRunningMakeUpTheWhole) {
  const std::string id = Submit();
  clock_.Advance(absl::Seconds(3));
  const jobs::Lease first = Claim();
  clock_.Advance(absl::Seconds(4));
  Release(first);
  clock_.Advance(absl::Seconds(5));
  const jobs::Lease second = Claim();
  clock_.Advance(absl::Seconds(6));
  Finish(second, Success());
  absl::Duration queued, running;
  for (const jobs::Transition& change : Transitions()) {
    if (change.from == JobState::kQueued) queued += change.in_state;
    if (change.from == JobState::kRunning) running += change.in_state;
  }
  EXPECT_EQ(queued, absl::Seconds(8));
  EXPECT_EQ(running, absl::Seconds(10));
  EXPECT_EQ(Get(id).end_time - Get(id).create_time, queued + running);
}

TEST_P(UpkeepTest, TheOldestJobThatCouldRunIsKnown) {
  EXPECT_EQ(store().Stats()->oldest_queued, absl::ZeroDuration());
  RunJob(ErrorWith(absl::StatusCode::kUnavailable));
  clock_.Advance(absl::Milliseconds(1));
  Submit(RequestOf("other"));
  clock_.Advance(absl::Milliseconds(500));
  Submit();
  EXPECT_EQ(store().Stats()->oldest_queued, absl::Milliseconds(500))
      << "not the one that waits for its next attempt";
}

TEST_P(UpkeepTest, AStoreSaysHowLargeItIs) {
  Submit();
  EXPECT_GT(store().Stats()->file_bytes + store().Stats()->wal_bytes, 0);
}

TEST_P(UpkeepTest, WorkersAreKnownUntilTheyAreLongGone) {
  Submit();
  Claim("alive");
  clock_.Advance(policy_.event_retention);
  TryClaim("new");
  Collect();
  const auto workers = *store().Workers();
  EXPECT_THAT(workers, Contains(Field(&jobs::WorkerInfo::id, "alive"))) << "it has a lease";
  LoseAllWorkers();
  Collect();
  EXPECT_THAT(*store().Workers(), Not(Contains(Field(&jobs::WorkerInfo::id, "alive"))));
  EXPECT_THAT(*store().Workers(), Contains(Field(&jobs::WorkerInfo::id, "new")));
}

TEST_P(UpkeepTest, ABackupIsAWholeStoreWhileTheStoreIsUsed) {
  std::vector<std::string> ids;
  for (int i = 0; i < 50; ++i) ids.push_back(Submit());
  const jobs::Lease lease = Claim();
  std::atomic<bool> stop = false;
  std::thread others([&] {
    while (!stop) Submit();
  });
  const Status status = store().BackUp(folder_.path() / "backup" / "jobs.db");
  EXPECT_EQ(ReasonOf(status), "CANNOT_WRITE") << "no such folder";
  std::filesystem::create_directory(folder_.path() / "backup");
  const Status backed_up = store().BackUp(folder_.path() / "backup" / "jobs.db");
  EXPECT_TRUE(backed_up.ok()) << backed_up;
  EXPECT_EQ(ReasonOf(store().BackUp(folder_.path() / "backup" / "jobs.db")), "FILE_EXISTS");
  stop = true;
  others.join();

  auto copy = GetParam().open(folder_.path() / "backup", policy_, [this] { return clock_.Now(); });
  ASSERT_TRUE(copy.ok()) << copy.status();
  for (const std::string& id : ids) {
    EXPECT_TRUE((*copy)->Get("default", id).ok()) << id;
  }
  EXPECT_TRUE((*copy)->Heartbeat(lease.fence, std::nullopt).ok()) << "running jobs go on in it";
  const auto findings = (*copy)->Diagnose();
  ASSERT_TRUE(findings.ok());
  for (const jobs::Finding& finding : *findings) {
    EXPECT_NE(finding.severity, jobs::Finding::Severity::kFault) << finding.message;
  }
}

TEST_P(UpkeepTest, AWorkerThatWasNotHeardOfIsAWarning) {
  TryClaim("silent");
  clock_.Advance(3 * policy_.lease);
  const auto findings = store().Diagnose();
  ASSERT_TRUE(findings.ok());
  bool warned = false;
  for (const jobs::Finding& finding : *findings) {
    warned |= finding.severity == jobs::Finding::Severity::kWarning &&
              finding.message.find("silent") != std::string::npos;
  }
  EXPECT_TRUE(warned);
}

INSTANTIATE_TEST_SUITE_P(Stores, UpkeepTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
