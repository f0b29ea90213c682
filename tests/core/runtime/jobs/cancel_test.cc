#include "tests/core/runtime/jobs/job_store_fixture.h"

// A wish to cancel: at once when nothing runs, through the heartbeat when something does, and by
// the reaper when its worker is dead. A success that was committed first stands.
namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;

class CancelTest : public JobStoreTest {
 protected:
  void ExpectCancelled(const std::string& id) {
    const api::Job job = Get(id);
    EXPECT_EQ(job.state, JobState::kCancelled);
    ASSERT_TRUE(job.error.has_value());
    EXPECT_EQ(job.error->code, absl::StatusCode::kCancelled);
    EXPECT_EQ(job.error->reason, "CANCELLED");
    EXPECT_EQ(job.cancel_requested_by, "tester");
    EXPECT_EQ(job.end_time, clock_.Now());
    EXPECT_EQ(job.expire_time, clock_.Now() + policy_.retention);
    EXPECT_EQ(job.next_attempt_time, absl::InfiniteFuture());
  }
};

TEST_P(CancelTest, AQueuedJobEndsAtOnce) {
  const std::string id = Submit();
  EXPECT_EQ(Cancel(id).state, JobState::kCancelled);
  ExpectCancelled(id);
  EXPECT_FALSE(TryClaim().has_value());
  EXPECT_EQ(StateHistory(id), "QUEUED CANCELLED");
  ExpectSound();
}

TEST_P(CancelTest, AJobThatWaitsForItsNextAttemptEndsAtOnce) {
  const std::string id = RunJob(ErrorWith(absl::StatusCode::kUnavailable));
  EXPECT_EQ(Cancel(id).state, JobState::kCancelled);
  ExpectCancelled(id);
  clock_.Advance(policy_.max_backoff);
  EXPECT_FALSE(TryClaim().has_value());
}

TEST_P(CancelTest, ARunningJobIsToldWithItsNextHeartbeat) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  EXPECT_EQ(Heartbeat(lease).directive, jobs::Directive::kContinue);
  EXPECT_EQ(Cancel(id).state, JobState::kCancelling);
  EXPECT_EQ(Heartbeat(lease).directive, jobs::Directive::kCancel);
  EXPECT_EQ(Get(id).state, JobState::kCancelling);
  EXPECT_EQ(Finish(lease, EndedAs(AttemptOutcome::kCancelled)), JobState::kCancelled);
  ExpectCancelled(id);
  EXPECT_EQ(Get(id).attempts.at(0).outcome, AttemptOutcome::kCancelled);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING CANCELLING CANCELLED");
}

TEST_P(CancelTest, TheFirstWhoAsksIsRemembered) {
  const std::string id = Submit();
  Claim();
  Cancel(id);
  EXPECT_TRUE(store().RequestCancel("default", id, "another").ok());
  EXPECT_EQ(Get(id).cancel_requested_by, "tester");
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING CANCELLING");
}

TEST_P(CancelTest, ASuccessThatCameFirstStands) {
  const std::string id = RunJob(Success());
  EXPECT_EQ(Cancel(id).state, JobState::kSucceeded);
  EXPECT_EQ(Get(id).cancel_requested_by, "");
}

TEST_P(CancelTest, ASuccessThatTheWishDidNotReachStands) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Cancel(id);
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(Get(id).error, std::nullopt);
}

TEST_P(CancelTest, NothingButSuccessStandsAgainstTheWish) {
  for (const auto& outcome :
       {ErrorWith(absl::StatusCode::kUnavailable), ErrorWith(absl::StatusCode::kInvalidArgument),
        EndedAs(AttemptOutcome::kStalled), EndedAs(AttemptOutcome::kLost)}) {
    SCOPED_TRACE(api::AttemptOutcomeName(outcome.outcome));
    const std::string id = Submit();
    const jobs::Lease lease = Claim();
    Cancel(id);
    EXPECT_EQ(Finish(lease, outcome), JobState::kCancelled);
    ExpectCancelled(id);
    EXPECT_EQ(Get(id).attempts.at(0).outcome, outcome.outcome) << "the attempt says what happened";
  }
}

TEST_P(CancelTest, AJobThatIsGivenBackEnds) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Cancel(id);
  Release(lease);
  ExpectCancelled(id);
}

TEST_P(CancelTest, TheReaperEndsTheJobOfADeadWorker) {
  const std::string id = Submit();
  Claim();
  Cancel(id);
  LoseAllWorkers();
  ExpectCancelled(id);
  EXPECT_EQ(Get(id).attempts.at(0).outcome, AttemptOutcome::kLost);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING CANCELLING CANCELLED");
  ExpectSound();
}

TEST_P(CancelTest, ARepeatedClaimStillGivesTheLeaseOfACancellingJob) {
  const std::string id = Submit();
  jobs::ClaimQuery query;
  query.token = "mine";
  TryClaim("worker-1", query);
  Cancel(id);
  const auto again = TryClaim("worker-1", query);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(Heartbeat(*again).directive, jobs::Directive::kCancel);
}

TEST_P(CancelTest, AnAttemptThatNobodyAskedToStopFailsTheJob) {
  const std::string id = RunJob(EndedAs(AttemptOutcome::kCancelled));
  EXPECT_EQ(Get(id).state, JobState::kFailed);
}

INSTANTIATE_TEST_SUITE_P(Stores, CancelTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
