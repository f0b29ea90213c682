#include <fmt/format.h>

#include <set>

#include "tests/core/runtime/jobs/job_store_fixture.h"

// Submitting twice is the same as once, and what does not fit is refused with a time to come back.
namespace poise::testing {
namespace {

using api::JobState;

class SubmitTest : public JobStoreTest {};

TEST_P(SubmitTest, TheSameRequestIdGivesTheSameJobAsItIsNow) {
  const auto first = store().Submit(Request("once"));
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_TRUE(first->created);
  Finish(Claim(), Success());
  const auto again = store().Submit(Request("once"));
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_FALSE(again->created);
  EXPECT_EQ(again->job.id, first->job.id);
  EXPECT_EQ(again->job.state, JobState::kSucceeded) << "as it is now";
  EXPECT_EQ(again->job.attempts.size(), 1);
  EXPECT_EQ(store().Stats()->submitted, 1);
}

TEST_P(SubmitTest, ARequestIdWithOtherContentIsRefused) {
  Submit(Request("once"));
  jobs::NewJob other = Request("once");
  other.content_digest = "another digest";
  const Status refused = store().Submit(other).status();
  EXPECT_EQ(ReasonOf(refused), "REQUEST_ID_REUSED");
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(base::ErrorField(refused), "request_id");
  EXPECT_EQ(store().Stats()->submitted, 1);
}

TEST_P(SubmitTest, RequestIdsOfTenantsAreApart) {
  jobs::NewJob other = Request("once");
  other.tenant = "other";
  EXPECT_NE(Submit(Request("once")), Submit(other));
}

TEST_P(SubmitTest, WithoutARequestIdEverySubmitIsAJob) { EXPECT_NE(Submit(), Submit()); }

TEST_P(SubmitTest, ARequestIdIsFreeAgainWhenItsJobIsDeleted) {
  const std::string id = Submit(Request("once"));
  Finish(Claim(), Success());
  EXPECT_TRUE(store().Delete("default", id).ok());
  EXPECT_NE(Submit(Request("once")), id);
}

TEST_P(SubmitTest, ThirtyTwoCallersOfOneRequestIdGetOneJob) {
  constexpr int kCallers = 32;
  constexpr int kRounds = 20;
  store();
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::string> ids(kCallers);
    std::atomic<int> created = 0;
    InParallel(kCallers, [&](int i) {
      const auto outcome = store().Submit(Request(fmt::format("race-{}", round)));
      ASSERT_TRUE(outcome.ok()) << outcome.status();
      ids[i] = outcome->job.id;
      created += outcome->created;
    });
    EXPECT_EQ(created, 1);
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), 1);
  }
  EXPECT_EQ(store().Stats()->submitted, kRounds);
  ExpectSound();
}

TEST_P(SubmitTest, ATenantWithTooManyQueuedJobsIsToldWhenToComeBack) {
  policy_.max_queued_per_tenant = 2;
  policy_.quota_retry_delay = absl::Seconds(7);
  Submit(Request("a"));
  Submit();
  const Status refused = store().Submit(Request()).status();
  EXPECT_EQ(ReasonOf(refused), "QUOTA_EXCEEDED");
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(base::RetryDelay(refused), absl::Seconds(7));
  EXPECT_TRUE(store().Submit(RequestOf("other")).ok()) << "only this tenant's";
  EXPECT_TRUE(store().Submit(Request("a")).ok()) << "known requests are answered all the same";
  Claim();
  EXPECT_TRUE(store().Submit(Request()).ok()) << "a running job is not queued";
  ExpectSound();
}

TEST_P(SubmitTest, AFullStoreRefusesEveryTenant) {
  policy_.max_unfinished = 2;
  const std::string id = Submit();
  Claim();
  Submit(RequestOf("other"));
  const Status refused = store().Submit(RequestOf("third")).status();
  EXPECT_EQ(ReasonOf(refused), "STORE_FULL");
  EXPECT_EQ(refused.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(base::RetryDelay(refused), policy_.quota_retry_delay);
  EXPECT_EQ(store().Stats()->jobs.count("third"), 0) << "nothing of it is left behind";
  Finish(*TryClaim(), Success());
  EXPECT_TRUE(store().Submit(RequestOf("third")).ok());
  EXPECT_EQ(Get(id).state, JobState::kRunning);
}

TEST_P(SubmitTest, WhatRunsIsNeverRefusedItsPlaceInTheQueue) {
  policy_.max_queued_per_tenant = 1;
  policy_.max_unfinished = 2;
  const std::string id = Submit();
  const jobs::Lease lease = Claim();
  Submit();
  Release(lease);
  EXPECT_EQ(Get(id).state, JobState::kQueued);
  ExpectSound();
}

TEST_P(SubmitTest, QuotasHoldWhenManyAskAtOnce) {
  policy_.max_queued_per_tenant = 10;
  store();
  std::atomic<int> accepted = 0;
  InParallel(32, [&](int) { accepted += store().Submit(Request()).ok(); });
  EXPECT_EQ(accepted, 10);
}

TEST_P(SubmitTest, ATenantRunsAtMostAsManyAsItMay) {
  policy_.max_running_per_tenant = 2;
  for (int i = 0; i < 3; ++i) Submit();
  const jobs::Lease first = Claim();
  Claim();
  EXPECT_FALSE(TryClaim().has_value());
  Submit(RequestOf("other"));
  EXPECT_TRUE(TryClaim().has_value());
  Finish(first, Success());
  EXPECT_TRUE(TryClaim().has_value());
}

INSTANTIATE_TEST_SUITE_P(Stores, SubmitTest, ::testing::ValuesIn(StoreKinds()), NameOfKind);

}  // namespace
}  // namespace poise::testing
