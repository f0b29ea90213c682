#include "core/engine/job_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/time/clock.h"
#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/support/temporary_folder.h"

namespace poise::engine {
namespace {

class JobManagerTest : public ::testing::Test {
 protected:
  JobManager& jobs() {
    if (!jobs_) {
      artifacts_ = *artifacts::ArtifactStore::Create({.root = folder_.path() / "artifacts"});
      auto store =
          jobs::OpenSqliteJobStore({.path = folder_.path() / "jobs.db", .policy = config_.policy});
      config_.data_dir = folder_.path();
      jobs_ = std::make_unique<JobManager>(config_, *std::move(store), *artifacts_,
                                           base::Telemetry::None());
    }
    return *jobs_;
  }

  static api::CreateJob Request(const std::string& parameters,
                                const std::string& request_id = "r1") {
    return {.spec = {.kind = "selftest", .parameters = base::Json::parse(parameters)},
            .request_id = request_id,
            .labels = {},
            .limits = {}};
  }

  // As if it had been stored two days ago.
  void MakeOld(const std::string& artifact) const {
    const std::string digest = artifact.substr(artifact.find('/') + 1);
    const std::filesystem::path file = folder_.path() / "artifacts" / digest.substr(0, 2) / digest;
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(48));
  }

  testing::TemporaryFolder folder_;
  absl::Duration ahead_;  // of the store's clock
  JobManagerConfig config_;
  std::unique_ptr<artifacts::ArtifactStore> artifacts_;
  std::unique_ptr<JobManager> jobs_;
};

TEST_F(JobManagerTest, SameWishInAnotherOrderIsTheSameRequest) {
  const auto first = jobs().Create({}, Request(R"({"steps": 3, "step_ms": 4})"));
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = jobs().Create({}, Request(R"({"step_ms": 4, "steps": 3})"));
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(first->id, second->id);
  const auto other = jobs().Create({}, Request(R"({"step_ms": 4, "steps": 5})"));
  EXPECT_EQ(base::ErrorReason(other.status()), "REQUEST_ID_REUSED");
}

TEST_F(JobManagerTest, LateStartOfATraceDoesNotMakeARequestAnother) {
  const auto first = jobs().Create({.trace_id = "a"}, Request("{}"));
  EXPECT_EQ(jobs().Create({.trace_id = "b"}, Request("{}"))->id, first->id);
  EXPECT_EQ(first->trace_id, "a");
}

TEST_F(JobManagerTest, EveryPartOfTheRequestButItsIdIsContent) {
  ASSERT_TRUE(jobs().Create({}, Request("{}")).ok());
  std::vector<api::CreateJob> others(5, Request("{}"));
  others[0].queue = "night";
  others[1].priority = 1;
  others[2].seed = 1;
  others[3].labels = {{"a", "b"}};
  others[4].limits.cancel_grace = absl::Seconds(9);
  for (const api::CreateJob& other : others) {
    EXPECT_EQ(base::ErrorReason(jobs().Create({}, other).status()), "REQUEST_ID_REUSED");
  }
}

TEST_F(JobManagerTest, ArtifactsThatNoJobNamesGoAfterTheirTime) {
  config_.artifact_interval = absl::Milliseconds(20);
  jobs();
  const std::string checkpoint = artifacts_->Put("a checkpoint")->name;
  const std::string orphan = artifacts_->Put("an orphan")->name;
  const std::string fresh = artifacts_->Put("a fresh upload")->name;
  ASSERT_TRUE(jobs().Create({}, Request("{}")).ok());
  ASSERT_TRUE(jobs().RegisterWorker({.id = "w", .slots = 1, .last_seen = {}}).ok());
  const auto lease = jobs().Claim({.worker = "w", .token = "0123456789abcdef"});
  ASSERT_TRUE(lease.ok() && lease->has_value()) << lease.status();
  ASSERT_TRUE(jobs().CommitCheckpoint((*lease)->fence, checkpoint, 1).ok());
  MakeOld(checkpoint);
  MakeOld(orphan);
  while (artifacts_->Get(orphan).ok()) absl::SleepFor(absl::Milliseconds(5));
  absl::SleepFor(absl::Milliseconds(100));
  EXPECT_TRUE(artifacts_->Get(checkpoint).ok());
  EXPECT_TRUE(artifacts_->Get(fresh).ok());
}

TEST_F(JobManagerTest, WorkerThatCouldNotBeHeardOfWhileThereWasNoServerKeepsItsJob) {
  ASSERT_TRUE(jobs().Create({}, Request("{}")).ok());
  ASSERT_TRUE(jobs().RegisterWorker({.id = "w", .slots = 1, .last_seen = {}}).ok());
  const auto lease = jobs().Claim({.worker = "w", .token = "0123456789abcdef"});
  ASSERT_TRUE(lease.ok() && lease->has_value()) << lease.status();
  jobs_.reset();
  ahead_ = 2 * config_.policy.lease;
  jobs();
  absl::SleepFor(absl::Milliseconds(50));
  EXPECT_TRUE(jobs().Heartbeat((*lease)->fence, std::nullopt).ok());
}

TEST_F(JobManagerTest, AJobSucceedsOnlyAfterItsResultIsKept) {
  std::vector<std::string> kept;
  Status answer = base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "", "disk full");
  config_.before_success = [&](const api::Job& job, const std::vector<api::JobArtifact>& files) {
    kept.push_back(job.id + " " + files.at(0).name);
    return answer;
  };
  const auto job = jobs().Create({}, Request("{}"));
  ASSERT_TRUE(job.ok()) << job.status();
  ASSERT_TRUE(jobs().RegisterWorker({.id = "w", .slots = 1, .last_seen = {}}).ok());
  const auto lease = jobs().Claim({.worker = "w", .token = "0123456789abcdef"});
  ASSERT_TRUE(lease.ok() && lease->has_value()) << lease.status();
  const jobs::Outcome outcome{.artifacts = {{"model", artifacts_->Put("weights")->name, 7, ""}}};
  EXPECT_EQ(base::ErrorReason(jobs().Finish((*lease)->fence, outcome).status()), "CANNOT_STORE");
  EXPECT_EQ(jobs().Get("default", job->id)->state, api::JobState::kRunning);
  answer = absl::OkStatus();
  EXPECT_EQ(*jobs().Finish((*lease)->fence, outcome), api::JobState::kSucceeded);
  // The answer was lost: nothing is kept twice.
  EXPECT_EQ(*jobs().Finish((*lease)->fence, outcome), api::JobState::kSucceeded);
  EXPECT_EQ(kept, (std::vector<std::string>{job->id + " model", job->id + " model"}));
  // And nobody without the lease gets anything kept.
  jobs::Fence stale = (*lease)->fence;
  stale.token = "fedcba9876543210";
  EXPECT_FALSE(jobs().Finish(stale, outcome).ok());
  EXPECT_EQ(kept.size(), 2u);
}

TEST_F(JobManagerTest, PolicyThatCannotWorkIsRefused) {
  const auto reason = [this](auto change) {
    JobManagerConfig config = config_;
    change(config);
    return base::ErrorField(config.Validate());
  };
  EXPECT_EQ(reason([](auto&) {}), "");
  EXPECT_EQ(reason([](auto& c) { c.policy.lease = absl::ZeroDuration(); }), "lease");
  EXPECT_EQ(reason([](auto& c) { c.policy.heartbeat_interval = c.policy.lease; }),
            "heartbeat_interval");
  EXPECT_EQ(reason([](auto& c) { c.policy.max_backoff = absl::Seconds(1); }), "max_backoff");
}

}  // namespace
}  // namespace poise::engine
