#include <map>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// Which ends are tried again, how often, and after what pause. Losing a worker does not cost what
// errors cost, and giving back costs nothing.
namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;
using ::testing::SizeIs;

class RetryTest : public JobStoreTest {
 protected:
  // Claims the job again, when it may be.
  jobs::Lease NextAttempt() {
    clock_.Advance(policy_.max_backoff);
    return Claim();
  }
};

TEST_P(RetryTest, OnlyErrorsThatARetryMayCureAreTriedAgain) {
  const std::map<absl::StatusCode, bool> table = {
      {absl::StatusCode::kCancelled, false},          {absl::StatusCode::kUnknown, false},
      {absl::StatusCode::kInvalidArgument, false},    {absl::StatusCode::kDeadlineExceeded, false},
      {absl::StatusCode::kNotFound, false},           {absl::StatusCode::kAlreadyExists, false},
      {absl::StatusCode::kPermissionDenied, false},   {absl::StatusCode::kResourceExhausted, true},
      {absl::StatusCode::kFailedPrecondition, false}, {absl::StatusCode::kAborted, true},
      {absl::StatusCode::kOutOfRange, false},         {absl::StatusCode::kUnimplemented, false},
      {absl::StatusCode::kInternal, false},           {absl::StatusCode::kUnavailable, true},
      {absl::StatusCode::kDataLoss, false},           {absl::StatusCode::kUnauthenticated, false}};
  for (const auto& [code, retried] : table) {
    SCOPED_TRACE(absl::StatusCodeToString(code));
    const std::string id = RunJob(ErrorWith(code));
    const api::Job job = Get(id);
    EXPECT_EQ(job.state, retried ? JobState::kQueued : JobState::kFailed);
    EXPECT_EQ(job.errors, retried ? 1 : 0);
    ASSERT_TRUE(job.error.has_value());
    EXPECT_EQ(*job.error, *ErrorWith(code).error) << "the last error is told, field and all";
    EXPECT_EQ(job.attempts.at(0).error, ErrorWith(code).error);
    Cancel(id);
  }
  ExpectSound();
}

TEST_P(RetryTest, TheNextAttemptWaitsWithinItsBand) {
  policy_.first_backoff = absl::Seconds(5);
  policy_.max_backoff = absl::Minutes(10);
  jobs::NewJob request = Request();
  request.request.limits.max_errors = 20;
  const std::string id = Submit(request);
  absl::Duration upper = policy_.first_backoff;
  for (int error = 1; error < 12; ++error) {
    Finish(Claim(), ErrorWith(absl::StatusCode::kUnavailable));
    const absl::Time next = Get(id).next_attempt_time;
    EXPECT_GT(next, clock_.Now()) << error;
    EXPECT_LE(next, clock_.Now() + upper) << error;
    clock_.Advance(next - clock_.Now() - absl::Milliseconds(1));
    EXPECT_FALSE(TryClaim().has_value()) << error;
    clock_.Advance(absl::Milliseconds(1));
    upper = std::min(2 * upper, policy_.max_backoff);
  }
  EXPECT_EQ(Claim().fence.attempt, 12);
  EXPECT_EQ(Get(id).next_attempt_time, absl::InfiniteFuture());
}

TEST_P(RetryTest, JobsThatFailedTogetherAreSpreadOut) {
  constexpr int kJobs = 200;
  policy_.first_backoff = absl::Seconds(100);
  std::vector<std::string> ids;
  for (int i = 0; i < kJobs; ++i) ids.push_back(RunJob(ErrorWith(absl::StatusCode::kAborted)));
  std::map<int64_t, int> tenths;
  for (const std::string& id : ids) {
    ++tenths[(Get(id).next_attempt_time - clock_.Now()) / absl::Seconds(10)];
  }
  for (int tenth = 0; tenth < 10; ++tenth) {
    EXPECT_GE(tenths[tenth], kJobs / 10 / 4) << "of " << kJobs << " in tenth " << tenth;
    EXPECT_LE(tenths[tenth], kJobs / 10 * 3) << "of " << kJobs << " in tenth " << tenth;
  }
}

TEST_P(RetryTest, APoisonJobEndsWithAllItsAttempts) {
  const std::string id = Submit();
  for (int attempt = 1; attempt < Request().request.limits.max_errors; ++attempt) {
    EXPECT_EQ(Finish(NextAttempt(), ErrorWith(absl::StatusCode::kUnavailable)), JobState::kQueued);
  }
  EXPECT_EQ(Finish(NextAttempt(), ErrorWith(absl::StatusCode::kUnavailable)), JobState::kFailed);
  const api::Job job = Get(id);
  EXPECT_EQ(job.errors, 3);
  EXPECT_EQ(job.error->reason, "BROKEN");
  ASSERT_THAT(job.attempts, SizeIs(3));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(job.attempts[i].attempt, i + 1);
    EXPECT_EQ(job.attempts[i].outcome, AttemptOutcome::kError);
    EXPECT_EQ(job.attempts[i].error->reason, "BROKEN");
  }
  EXPECT_FALSE(TryClaim().has_value());
  ExpectSound();
}

TEST_P(RetryTest, AStallCostsAnError) {
  jobs::NewJob request = Request();
  request.request.limits.max_errors = 2;
  const std::string id = Submit(request);
  EXPECT_EQ(Finish(Claim(), EndedAs(AttemptOutcome::kStalled)), JobState::kQueued);
  EXPECT_EQ(Get(id).errors, 1);
  EXPECT_EQ(Finish(NextAttempt(), EndedAs(AttemptOutcome::kStalled)), JobState::kFailed);
  const api::Job job = Get(id);
  EXPECT_EQ(job.error->reason, "STALLED");
  EXPECT_EQ(job.attempts.at(1).outcome, AttemptOutcome::kStalled);
  EXPECT_EQ(job.losses, 0);
}

TEST_P(RetryTest, LossesHaveTheirOwnBudgetAndCostNoPause) {
  jobs::NewJob request = Request();
  request.request.limits.max_losses = 3;
  const std::string id = Submit(request);
  for (int loss = 1; loss < 3; ++loss) {
    Claim();
    LoseAllWorkers();
    EXPECT_EQ(Get(id).state, JobState::kQueued);
    EXPECT_EQ(Get(id).losses, loss);
    EXPECT_EQ(Get(id).next_attempt_time, absl::InfiniteFuture()) << "claimable at once";
  }
  EXPECT_EQ(Finish(Claim(), EndedAs(AttemptOutcome::kLost)), JobState::kFailed);
  const api::Job job = Get(id);
  EXPECT_EQ(job.errors, 0);
  EXPECT_EQ(job.error->reason, "PROCESS_LOST");
  EXPECT_EQ(job.attempts.at(0).error->reason, "WORKER_LOST");
  ASSERT_THAT(job.attempts, SizeIs(3));
}

TEST_P(RetryTest, ACheckpointThatMovesOnForgivesTheLosses) {
  jobs::NewJob request = Request();
  request.request.limits.max_losses = 2;
  const std::string id = Submit(request);
  for (int64_t step = 1; step <= 5; ++step) {
    const jobs::Lease lease = Claim();
    Checkpoint(lease, 10 * step);
    EXPECT_EQ(Get(id).losses, 0);
    LoseAllWorkers();
    EXPECT_EQ(Get(id).losses, 1);
  }
  Checkpoint(Claim(), 50);  // no further than before
  EXPECT_EQ(Get(id).losses, 1);
  LoseAllWorkers();
  EXPECT_EQ(Get(id).state, JobState::kFailed);
}

TEST_P(RetryTest, ACheckpointForgivesNoErrors) {
  const std::string id = Submit();
  Finish(Claim(), ErrorWith(absl::StatusCode::kUnavailable));
  Checkpoint(NextAttempt(), 10);
  EXPECT_EQ(Get(id).errors, 1);
}

TEST_P(RetryTest, TenReleasesLeaveTheBudgetsUntouched) {
  jobs::NewJob request = Request();
  request.request.limits.max_errors = 1;
  request.request.limits.max_losses = 1;
  const std::string id = Submit(request);
  for (int i = 0; i < 10; ++i) {
    const jobs::Lease lease = Claim();  // at once, each time
    EXPECT_EQ(lease.fence.attempt, i + 1);
    Release(lease);
  }
  api::Job job = Get(id);
  EXPECT_EQ(job.state, JobState::kQueued);
  EXPECT_EQ(job.errors, 0);
  EXPECT_EQ(job.losses, 0);
  EXPECT_EQ(job.error, std::nullopt);
  ASSERT_THAT(job.attempts, SizeIs(10));
  EXPECT_EQ(job.attempts[9].outcome, AttemptOutcome::kReleased);
  EXPECT_EQ(job.attempts[9].error, std::nullopt);
  EXPECT_EQ(Finish(Claim(), Success()), JobState::kSucceeded);
  ExpectSound();
}

TEST_P(RetryTest, ReleasingTwiceIsOnce) {
  Submit();
  const jobs::Lease lease = Claim();
  Release(lease);
  Release(lease);
  const jobs::Lease next = Claim();
  Release(lease);
  EXPECT_EQ(Heartbeat(next).directive, jobs::Directive::kContinue) << "the next attempt goes on";
}

TEST_P(RetryTest, SuccessForgetsTheErrorBefore) {
  const std::string id = Submit();
  Finish(Claim(), ErrorWith(absl::StatusCode::kUnavailable));
  Finish(NextAttempt(), Success());
  EXPECT_EQ(Get(id).error, std::nullopt);
  EXPECT_EQ(Get(id).attempts.at(0).error->reason, "BROKEN");
}

INSTANTIATE_TEST_SUITE_P(Stores, RetryTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
