#include "tests/core/runtime/jobs/job_store_fixture.h"

// How long a worker may keep a job: as long as it is heard of, and not past the job's deadline.
namespace poise::testing {
namespace {

using api::JobState;

class LeaseTest : public JobStoreTest {
 protected:
  std::string SubmitWithDeadline(absl::Duration deadline) {
    jobs::NewJob request = Request();
    request.request.limits.deadline = deadline;
    return Submit(request);
  }
  void ExpectDeadlineExceeded(const std::string& id) {
    const api::Job job = Get(id);
    EXPECT_EQ(job.state, JobState::kFailed);
    ASSERT_TRUE(job.error.has_value());
    EXPECT_EQ(job.error->code, absl::StatusCode::kDeadlineExceeded);
    EXPECT_EQ(job.error->reason, "DEADLINE_EXCEEDED");
  }
};

TEST_P(LeaseTest, AHealthyJobTenLeasesLongHasOneAttempt) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  for (absl::Duration run; run < 10 * policy_.lease; run += policy_.heartbeat_interval) {
    clock_.Advance(policy_.heartbeat_interval);
    EXPECT_EQ(Heartbeat(lease).expires_in, policy_.lease);
    EXPECT_EQ(Reap(), 0);
  }
  Finish(lease, Success());
  EXPECT_EQ(Get(id).attempt, 1);
}

TEST_P(LeaseTest, ALeaseEndsWhenItIsDueAndNotBefore) {
  const std::string id = Submit();
  Claim();
  clock_.Advance(policy_.lease - absl::Milliseconds(1));
  EXPECT_EQ(Reap(), 0);
  EXPECT_EQ(Get(id).state, JobState::kRunning);
  clock_.Advance(absl::Milliseconds(1));
  EXPECT_EQ(Reap(), 1);
  EXPECT_EQ(Get(id).state, JobState::kQueued);
  EXPECT_EQ(Reap(), 0);
}

TEST_P(LeaseTest, AHeartbeatBeforeTheReaperSavesALateLease) {
  Submit();
  const jobs::Lease lease = Claim();
  clock_.Advance(2 * policy_.lease);
  Heartbeat(lease);
  EXPECT_EQ(Reap(), 0);
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
}

TEST_P(LeaseTest, ALateSuccessBeforeTheReaperCounts) {
  Submit();
  const jobs::Lease lease = Claim();
  clock_.Advance(2 * policy_.lease);
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(Reap(), 0);
}

TEST_P(LeaseTest, ALostJobKeepsItsPlaceInTheQueue) {
  const std::string first = Submit();
  clock_.Advance(absl::Seconds(1));
  Submit();
  Claim();
  LoseAllWorkers();
  EXPECT_EQ(Claim().fence.job, first);
}

TEST_P(LeaseTest, AClaimRepeatedForeverLosesTheLeaseInTheEnd) {
  const std::string id = Submit();
  jobs::ClaimQuery query;
  query.token = "mine";
  bool reaped = false;
  for (int i = 0; i < 100 && !reaped; ++i) {
    const auto lease = TryClaim("worker-1", query);
    ASSERT_TRUE(lease.has_value());
    EXPECT_EQ(lease->fence.attempt, 1);
    EXPECT_LE(lease->expires_in, policy_.lease);
    clock_.Advance(policy_.heartbeat_interval);
    reaped = Reap() == 1;
  }
  EXPECT_TRUE(reaped) << "nobody ever heard of the attempt";
  EXPECT_EQ(Get(id).state, JobState::kQueued);
}

TEST_P(LeaseTest, WhenTheClockIsSetBackADeadWorkerIsStillNoticed) {
  const std::string id = Submit();
  Claim();
  clock_.Advance(-absl::Hours(1));
  EXPECT_EQ(Reap(), 0);
  clock_.Advance(policy_.lease);
  EXPECT_EQ(Reap(), 1);
  EXPECT_EQ(Get(id).state, JobState::kQueued);
}

TEST_P(LeaseTest, LeasesOutliveTheStoresRestart) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Cancel(id);
  CloseStore();
  EXPECT_EQ(Heartbeat(lease).directive, jobs::Directive::kCancel);
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING CANCELLING SUCCEEDED");
}

TEST_P(LeaseTest, AQueuedJobPastItsDeadlineFails) {
  const std::string id = SubmitWithDeadline(absl::Seconds(10));
  clock_.Advance(absl::Seconds(10) - absl::Milliseconds(1));
  EXPECT_EQ(Reap(), 0);
  clock_.Advance(absl::Milliseconds(1));
  EXPECT_EQ(Reap(), 1);
  ExpectDeadlineExceeded(id);
  EXPECT_EQ(StateHistory(id), "QUEUED FAILED");
  ExpectSound();
}

TEST_P(LeaseTest, AJobPastItsDeadlineIsNeverStarted) {
  const std::string late = SubmitWithDeadline(absl::Seconds(10));
  const std::string next = SubmitWithDeadline(absl::Seconds(20));
  clock_.Advance(absl::Seconds(10));
  EXPECT_EQ(Claim().fence.job, next);
  ExpectDeadlineExceeded(late);
}

TEST_P(LeaseTest, ThousandsOfJobsPastTheirDeadlineHoldNobodyUp) {
  constexpr int kJobs = 1000;
  jobs::NewJob request = Request();
  request.request.limits.deadline = absl::Seconds(10);
  SubmitMany(request, kJobs);
  clock_.Advance(absl::Seconds(10));
  EXPECT_FALSE(TryClaim().has_value());
  EXPECT_GT(Reap(), 0) << "one claim has not ended them all";
  EXPECT_EQ(store().Stats()->jobs.at("default").at(JobState::kFailed), kJobs);
}

TEST_P(LeaseTest, ARetryThatWaitsPastTheDeadlineFails) {
  policy_.first_backoff = absl::Hours(10);
  policy_.max_backoff = absl::Hours(10);
  const std::string id = SubmitWithDeadline(absl::Seconds(10));
  Finish(Claim(), ErrorWith(absl::StatusCode::kUnavailable));
  clock_.Advance(absl::Seconds(10));
  EXPECT_EQ(Reap(), 1);
  ExpectDeadlineExceeded(id);
}

TEST_P(LeaseTest, ARunningJobHasOneLeaseToAnswerAfterItsDeadline) {
  const std::string id = SubmitWithDeadline(absl::Seconds(10));
  const jobs::Lease lease = Claim();
  EXPECT_EQ(lease.deadline_in, absl::Seconds(10));
  clock_.Advance(absl::Seconds(10) + policy_.lease);
  Heartbeat(lease);
  EXPECT_EQ(Reap(), 0);
  clock_.Advance(absl::Milliseconds(1));
  EXPECT_EQ(Reap(), 1);
  ExpectDeadlineExceeded(id);
  EXPECT_EQ(Get(id).attempts.at(0).error->reason, "DEADLINE_EXCEEDED");
  EXPECT_EQ(ReasonOf(store().Finish(lease.fence, Success())), "LEASE_LOST");
}

TEST_P(LeaseTest, ASuccessAfterTheDeadlineStillCounts) {
  SubmitWithDeadline(absl::Seconds(10));
  const jobs::Lease lease = Claim();
  clock_.Advance(absl::Seconds(11));
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
}

TEST_P(LeaseTest, ADeadlineIsKeptAcrossAttempts) {
  const std::string id = SubmitWithDeadline(absl::Minutes(2));
  Claim();
  LoseAllWorkers();
  EXPECT_EQ(Claim().deadline_in, absl::Minutes(2) - policy_.lease);
  LoseAllWorkers();
  clock_.Advance(absl::Minutes(2));
  Reap();
  ExpectDeadlineExceeded(id);
}

INSTANTIATE_TEST_SUITE_P(Stores, LeaseTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
