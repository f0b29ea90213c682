#include "tests/core/runtime/jobs/job_store_fixture.h"

// A job's life on the straight path: made, claimed, heard of, finished.
namespace poise::testing {
namespace {

using api::AttemptOutcome;
using api::JobState;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class LifecycleTest : public JobStoreTest {};

TEST_P(LifecycleTest, KeepsEverythingThatWasAskedFor) {
  jobs::NewJob request = Request("once");
  request.trace_id = "trace-1";
  request.request.queue = "fast";
  request.request.priority = -3;
  request.request.seed = 0xfedcba9876543210;
  request.request.labels = {{"run", "7"}, {"a.b", "ü"}};
  request.request.limits = {.max_errors = 2,
                            .max_losses = 4,
                            .deadline = absl::Hours(1),
                            .stall_timeout = absl::Seconds(7),
                            .cancel_grace = absl::Milliseconds(1500)};
  request.request.spec.parameters = base::Json{{"z", 1.5}, {"a", {1, "two", nullptr}}};

  const api::Job job = Get(Submit(request));

  EXPECT_EQ(job.state, JobState::kQueued);
  EXPECT_EQ(job.tenant, "default");
  EXPECT_EQ(job.spec.kind, "selftest");
  EXPECT_EQ(job.spec.parameters.dump(), R"({"z":1.5,"a":[1,"two",null]})");
  EXPECT_EQ(job.request_id, "once");
  EXPECT_EQ(job.queue, "fast");
  EXPECT_EQ(job.priority, -3);
  EXPECT_EQ(job.seed, 0xfedcba9876543210);
  EXPECT_EQ(job.labels, request.request.labels);
  EXPECT_EQ(job.limits.max_errors, 2);
  EXPECT_EQ(job.limits.max_losses, 4);
  EXPECT_EQ(job.limits.deadline, absl::Hours(1));
  EXPECT_EQ(job.limits.stall_timeout, absl::Seconds(7));
  EXPECT_EQ(job.limits.cancel_grace, absl::Milliseconds(1500));
  EXPECT_EQ(job.trace_id, "trace-1");
  EXPECT_EQ(job.create_time, clock_.Now());
  EXPECT_EQ(job.start_time, absl::InfiniteFuture());
  EXPECT_EQ(job.end_time, absl::InfiniteFuture());
  EXPECT_THAT(job.attempts, IsEmpty());
}

TEST_P(LifecycleTest, RunsAJobToSuccess) {
  jobs::NewJob request = Request();
  request.request.seed = 42;
  request.request.limits.deadline = absl::Minutes(10);
  const std::string id = Submit(request);
  clock_.Advance(absl::Seconds(5));

  const jobs::Lease lease = Claim();
  EXPECT_EQ(lease.fence.job, id);
  EXPECT_EQ(lease.fence.attempt, 1);
  EXPECT_EQ(lease.expires_in, policy_.lease);
  EXPECT_EQ(lease.spec.kind, "selftest");
  EXPECT_EQ(lease.spec.parameters, request.request.spec.parameters);
  EXPECT_EQ(lease.seed, 42);
  EXPECT_EQ(lease.deadline_in, absl::Minutes(10) - absl::Seconds(5));
  EXPECT_FALSE(lease.checkpoint.has_value());
  EXPECT_EQ(Get(id).state, JobState::kRunning);
  EXPECT_EQ(Get(id).worker, "worker-1");

  clock_.Advance(absl::Seconds(10));
  const auto reply =
      store().Heartbeat(lease.fence, base::Progress{2, 3, "half way", {{"reward", 0.5}}});
  ASSERT_TRUE(reply.ok());
  EXPECT_EQ(reply->directive, jobs::Directive::kContinue);
  EXPECT_EQ(reply->expires_in, policy_.lease);
  EXPECT_EQ(Get(id).progress.message, "half way");
  EXPECT_EQ(Get(id).progress.metrics.at("reward"), 0.5);

  jobs::Outcome outcome = Success();
  outcome.artifacts = {{"out.bvh", "artifacts/" + std::string(64, 'a'), 17, "text/plain"}};
  outcome.usage = {.cpu_seconds = 1.25, .peak_memory_bytes = 1 << 20};
  EXPECT_EQ(Finish(lease, outcome), JobState::kSucceeded);

  const api::Job job = Get(id);
  EXPECT_EQ(job.state, JobState::kSucceeded);
  EXPECT_EQ(job.artifacts, outcome.artifacts);
  EXPECT_EQ(job.progress.step, 2);
  EXPECT_EQ(job.worker, "");
  EXPECT_EQ(job.start_time, job.create_time + absl::Seconds(5));
  EXPECT_EQ(job.end_time, clock_.Now());
  EXPECT_EQ(job.expire_time, clock_.Now() + policy_.retention);
  ASSERT_THAT(job.attempts, SizeIs(1));
  EXPECT_EQ(job.attempts[0].outcome, AttemptOutcome::kSucceeded);
  EXPECT_EQ(job.attempts[0].worker, "worker-1");
  EXPECT_EQ(job.attempts[0].usage.cpu_seconds, 1.25);
  EXPECT_EQ(job.attempts[0].usage.peak_memory_bytes, 1 << 20);
  EXPECT_EQ(job.attempts[0].last_step, 2);
  EXPECT_EQ(job.attempts[0].start, job.start_time);
  EXPECT_EQ(job.attempts[0].end, job.end_time);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING SUCCEEDED");
  ExpectSound();
}

TEST_P(LifecycleTest, FinishTwiceIsOnce) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(ReasonOf(store().Finish(lease.fence, ErrorWith(absl::StatusCode::kInternal))),
            "LEASE_LOST");
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING SUCCEEDED");
}

TEST_P(LifecycleTest, FinishTwiceTellsWhatTheFirstLedTo) {
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  const jobs::Outcome broken = ErrorWith(absl::StatusCode::kUnavailable);
  EXPECT_EQ(Finish(lease, broken), JobState::kQueued);
  clock_.Advance(policy_.max_backoff);
  Claim("worker-2");
  EXPECT_EQ(Finish(lease, broken), JobState::kQueued) << "of its own attempt";
  EXPECT_EQ(Get(id).state, JobState::kRunning) << "the second attempt goes on";
  EXPECT_EQ(Get(id).errors, 1);
}

TEST_P(LifecycleTest, AnotherTenantsJobIsNotFound) {
  const std::string id = Submit();
  EXPECT_EQ(ReasonOf(store().Get("other", id)), "JOB_NOT_FOUND");
  EXPECT_EQ(ReasonOf(store().RequestCancel("other", id, "x")), "JOB_NOT_FOUND");
  EXPECT_EQ(ReasonOf(store().Delete("other", id)), "JOB_NOT_FOUND");
  EXPECT_EQ(ReasonOf(store().Get("default", "nothing")), "JOB_NOT_FOUND");
  EXPECT_EQ(ReasonOf(store().ReadEvents("nothing", 0, 10)), "JOB_NOT_FOUND");
}

TEST_P(LifecycleTest, AWorkerRegistersFirst) {
  Submit();
  jobs::ClaimQuery query{"stranger", "token", {}, {}};
  EXPECT_EQ(ReasonOf(store().Claim(query)), "UNKNOWN_WORKER");
}

TEST_P(LifecycleTest, AClaimRepeatedWithItsTokenGivesTheSameLease) {
  Submit();
  Submit();
  jobs::ClaimQuery query;
  query.token = "mine";
  const auto first = TryClaim("worker-1", query);
  const auto again = TryClaim("worker-1", query);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(first->fence.job, again->fence.job);
  EXPECT_EQ(again->fence.attempt, 1);
  EXPECT_EQ(again->fence.token, "mine");
  EXPECT_NE(Claim("worker-2").fence.job, first->fence.job);
  EXPECT_EQ(store().Stats()->leases, 2);
}

TEST_P(LifecycleTest, AnotherAttemptFollowsALostWorker) {
  const std::string id = Submit();
  const jobs::Lease lost = Claim("worker-1");
  clock_.Advance(policy_.lease);
  EXPECT_EQ(Reap(), 1);
  EXPECT_EQ(Get(id).state, JobState::kQueued);
  EXPECT_EQ(Get(id).losses, 1);
  const jobs::Lease lease = Claim("worker-2");
  EXPECT_EQ(lease.fence.attempt, 2);
  EXPECT_EQ(ReasonOf(store().Heartbeat(lost.fence, std::nullopt)), "LEASE_LOST");
  EXPECT_EQ(ReasonOf(store().Finish(lost.fence, Success())), "LEASE_LOST");
  EXPECT_EQ(Finish(lease, Success()), JobState::kSucceeded);
  EXPECT_EQ(StateHistory(id), "QUEUED RUNNING QUEUED RUNNING SUCCEEDED");
  ExpectSound();
}

INSTANTIATE_TEST_SUITE_P(Stores, LifecycleTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
