#include <fmt/format.h>

#include <algorithm>

#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/fragile_disk.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// What was acknowledged survives power loss: the log is synced before the answer, and what a sync
// has made durable is a whole store. And when the disk fails, nothing is lost that was promised.
namespace poise::testing {
namespace {

using Kind = FragileDisk::Step::Kind;
using ::testing::IsEmpty;
using ::testing::Not;

class SqlitePowerLossTest : public ::testing::Test {
 protected:
  SqlitePowerLossTest() {
    store_ = Open(folder_.path());
    disk_.StopTakingPart();
    EXPECT_TRUE(store_->UpsertWorker({.id = "worker"}).ok());
    disk_.TakeSteps();
  }
  ~SqlitePowerLossTest() override { store_.reset(); }

  static std::unique_ptr<jobs::JobStore> Open(const std::filesystem::path& folder) {
    auto store = jobs::OpenSqliteJobStore({.path = folder / "jobs.db"});
    EXPECT_TRUE(store.ok()) << store.status();
    return store.ok() ? std::move(*store) : nullptr;
  }
  StatusOr<jobs::SubmitOutcome> Submit(const std::string& request_id) {
    jobs::NewJob job;
    job.request.spec = {"selftest", {{"padding", std::string(500, 'x')}}};
    job.request.request_id = request_id;
    return store_->Submit(job);
  }
  // The log was written, and synced after its last write.
  void ExpectSyncedLog(const char* call) {
    const auto steps = disk_.TakeSteps();
    int writes = 0;
    bool durable = false;
    for (const auto& [kind, file] : steps) {
      if (file != "jobs.db-wal") continue;
      writes += kind == Kind::kWrite;
      durable = kind == Kind::kSync;
    }
    EXPECT_GT(writes, 0) << call;
    EXPECT_TRUE(durable) << call << ": answered before the log was synced";
  }
  // What the power loss left is a sound store that holds each job with its state.
  void ExpectAllThere(const std::map<std::string, api::JobState>& jobs, base::Random* random) {
    const TemporaryFolder after;
    disk_.LosePower(after.path(), random);
    const auto store = Open(after.path());
    ASSERT_NE(store, nullptr);
    for (const auto& [id, state] : jobs) {
      const auto job = store->Get("default", id);
      ASSERT_TRUE(job.ok()) << "job " << id << " was acknowledged and is lost";
      EXPECT_EQ(job->state, state);
    }
    const auto findings = store->Diagnose();
    ASSERT_TRUE(findings.ok());
    for (const jobs::Finding& finding : *findings) {
      EXPECT_NE(finding.severity, jobs::Finding::Severity::kFault) << finding.message;
    }
  }

  const TemporaryFolder folder_;
  FragileDisk disk_;
  std::unique_ptr<jobs::JobStore> store_;
};

TEST_F(SqlitePowerLossTest, EveryAnswerToAWriteComesAfterTheSyncOfTheLog) {
  const auto submitted = Submit("a");
  ExpectSyncedLog("Submit");
  const auto lease = *store_->Claim({"worker", "token"});
  ExpectSyncedLog("Claim");
  EXPECT_TRUE(store_->Heartbeat(lease->fence, std::nullopt).ok());
  ExpectSyncedLog("Heartbeat");
  EXPECT_TRUE(store_->CommitCheckpoint(lease->fence, ArtifactName('c'), 1).ok());
  ExpectSyncedLog("CommitCheckpoint");
  EXPECT_TRUE(store_->RequestCancel("default", submitted->job.id, "x").ok());
  ExpectSyncedLog("RequestCancel");
  EXPECT_TRUE(store_->Finish(lease->fence, Success()).ok());
  ExpectSyncedLog("Finish");
  EXPECT_TRUE(store_->Delete("default", submitted->job.id).ok());
  ExpectSyncedLog("Delete");
}

TEST_F(SqlitePowerLossTest, EveryAcknowledgedJobIsThereAfterwards) {
  constexpr int kJobs = 150;
  base::Random random(1);
  std::map<std::string, api::JobState> acknowledged;
  for (int i = 0; i < kJobs; ++i) {
    const auto outcome = Submit(fmt::format("request-{}", i));
    ASSERT_TRUE(outcome.ok()) << outcome.status();
    acknowledged[outcome->job.id] = api::JobState::kQueued;
    if (i % 3 == 0) {
      const auto lease = *store_->Claim({"worker", fmt::format("token-{}", i)});
      ASSERT_TRUE(lease.has_value());
      acknowledged[lease->fence.job] = *store_->Finish(lease->fence, Success());
    }
    ExpectAllThere(acknowledged, i % 2 == 0 ? nullptr : &random);
    if (HasFailure()) return;
  }
  const auto steps = disk_.TakeSteps();
  EXPECT_TRUE(std::any_of(steps.begin(), steps.end(), [](const FragileDisk::Step& step) {
    return step.file == "jobs.db" && step.kind == Kind::kSync;
  })) << "the log was never moved into the file: the harder half was not tried";
}

// Not the model of a disk but the files themselves, as a killed process leaves them.
TEST_F(SqlitePowerLossTest, ACopyOfTheFilesTakenAfterEachAnswerHoldsTheJob) {
  for (int i = 0; i < 50; ++i) {
    const auto outcome = Submit(fmt::format("request-{}", i));
    ASSERT_TRUE(outcome.ok()) << outcome.status();
    const TemporaryFolder copy;
    for (const char* name : {"jobs.db", "jobs.db-wal"}) {
      std::filesystem::copy_file(folder_.path() / name, copy.path() / name);
    }
    EXPECT_TRUE(Open(copy.path())->Get("default", outcome->job.id).ok());
  }
}

TEST_F(SqlitePowerLossTest, AFullDiskRefusesNewJobsAndKeepsTheOldOnes) {
  const auto before = Submit("before");
  ASSERT_TRUE(before.ok());
  disk_.FailWrites(SQLITE_FULL);
  const Status refused = Submit("refused").status();
  EXPECT_EQ(ReasonOf(refused), "STORE_UNAVAILABLE");
  EXPECT_EQ(refused.code(), absl::StatusCode::kUnavailable);
  EXPECT_TRUE(base::RetryDelay(refused).has_value());
  EXPECT_TRUE(store_->Get("default", before->job.id).ok()) << "reads go on";
  disk_.FailWrites(SQLITE_OK);
  const auto again = Submit("refused");
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_TRUE(again->created);
  ExpectAllThere(
      {{before->job.id, api::JobState::kQueued}, {again->job.id, api::JobState::kQueued}}, nullptr);
}

TEST_F(SqlitePowerLossTest, AFailedSyncIsNoAnswer) {
  for (int i = 0; i < 20; ++i) {
    const std::string request_id = fmt::format("request-{}", i);
    disk_.FailSyncs(SQLITE_IOERR_FSYNC);
    EXPECT_EQ(ReasonOf(Submit(request_id)), "STORE_UNAVAILABLE");
    disk_.FailSyncs(SQLITE_OK);
    const auto again = Submit(request_id);
    ASSERT_TRUE(again.ok()) << again.status();
    ExpectAllThere({{again->job.id, api::JobState::kQueued}}, nullptr);
  }
  EXPECT_EQ(store_->Stats()->submitted, 20) << "the client asked twice, and has one job each";
}

}  // namespace
}  // namespace poise::testing
