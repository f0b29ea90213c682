#include "core/runtime/jobs/job_rules.h"

#include <gtest/gtest.h>

#include "core/runtime/jobs/job_json.h"

namespace poise::jobs {
namespace {

using api::AttemptOutcome;
using api::JobState;

TEST(JobRulesTest, TheSameJobAndErrorWaitTheSameTime) {
  const JobPolicy policy;
  EXPECT_EQ(RetryDelay(policy, "job", 2), RetryDelay(policy, "job", 2));
  EXPECT_NE(RetryDelay(policy, "job", 2), RetryDelay(policy, "other", 2));
  EXPECT_NE(RetryDelay(policy, "job", 2), RetryDelay(policy, "job", 3));
}

TEST(JobRulesTest, ADelayIsNeverNothingAndNeverMoreThanTheMost) {
  const JobPolicy policy;
  for (const int errors : {1, 2, 10, 1000, 1'000'000}) {
    EXPECT_GT(RetryDelay(policy, "job", errors), absl::ZeroDuration()) << errors;
    EXPECT_LE(RetryDelay(policy, "job", errors), policy.max_backoff) << errors;
  }
}

TEST(JobRulesTest, PrioritiesOfAnExtremeAgeStepDoNotOverflow) {
  JobPolicy policy;
  policy.age_step = absl::InfiniteDuration();
  const absl::Time now = absl::FromUnixSeconds(1'800'000'000);
  EXPECT_LT(ClaimKey(policy, now, 10), ClaimKey(policy, now, 9));
  EXPECT_LT(ClaimKey(policy, now, -9), ClaimKey(policy, now, -10));
  policy.age_step = absl::ZeroDuration();
  EXPECT_LT(ClaimKey(policy, now, 1), ClaimKey(policy, now, 0));
}

TEST(JobRulesTest, AnEndWithoutAnErrorStillSaysWhy) {
  for (const AttemptOutcome outcome : {AttemptOutcome::kError, AttemptOutcome::kStalled,
                                       AttemptOutcome::kLost, AttemptOutcome::kCancelled}) {
    const EndDecision decision = DecideEnd(
        {}, {.job = "j", .outcome = outcome, .error = {}, .limits = {}, .cancelled_by = {}});
    ASSERT_TRUE(decision.attempt_error.has_value());
    EXPECT_NE(decision.attempt_error->reason, "");
    EXPECT_NE(decision.attempt_error->message, "");
    EXPECT_NE(decision.attempt_error->code, absl::StatusCode::kOk);
  }
}

TEST(JobRulesTest, TheWishToCancelIsNamedEvenWithoutAName) {
  EXPECT_EQ(CancelledBy("").message, "cancelled by somebody");
  EXPECT_EQ(CancelledBy("ann").message, "cancelled by ann");
}

TEST(JobJsonTest, DamagedTextIsDataLoss) {
  for (const char* text : {"", "{", "[]", "{\"step\":\"x\"}", "null", "{\"max_errors\":1}"}) {
    EXPECT_EQ(base::ErrorReason(ParseProgress(text).status()), "STORE_CORRUPT") << text;
    EXPECT_EQ(base::ErrorReason(ParseCheckpoint(text).status()), "STORE_CORRUPT") << text;
    EXPECT_EQ(base::ErrorReason(ParseLimits(text).status()), "STORE_CORRUPT") << text;
    EXPECT_EQ(base::ErrorReason(ParseError(text).status()), "STORE_CORRUPT") << text;
  }
  EXPECT_EQ(base::ErrorReason(ParseArtifacts("{}x").status()), "STORE_CORRUPT");
  EXPECT_EQ(base::ErrorReason(ParseLabels("[1]").status()), "STORE_CORRUPT");
  EXPECT_EQ(ParseProgress("{").status().code(), absl::StatusCode::kDataLoss);
}

TEST(JobJsonTest, LimitsComeBackAsTheyWere) {
  const api::JobLimits limits{.max_errors = 7,
                              .max_losses = 8,
                              .deadline = absl::InfiniteDuration(),
                              .stall_timeout = absl::Milliseconds(1),
                              .cancel_grace = absl::Hours(100)};
  const auto read = ParseLimits(ToJson(limits));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->max_errors, 7);
  EXPECT_EQ(read->max_losses, 8);
  EXPECT_EQ(read->deadline, absl::InfiniteDuration());
  EXPECT_EQ(read->stall_timeout, absl::Milliseconds(1));
  EXPECT_EQ(read->cancel_grace, absl::Hours(100));
  EXPECT_EQ(
      ParseLimits(ToJson(api::JobLimits{.stall_timeout = absl::Nanoseconds(1)}))->stall_timeout,
      absl::Milliseconds(1))
      << "never nothing";
}

TEST(JobJsonTest, OutcomesDifferByWhatTheySay) {
  Outcome one{.outcome = AttemptOutcome::kSucceeded};
  Outcome other = one;
  EXPECT_EQ(OutcomeDigest(one), OutcomeDigest(other));
  other.usage.cpu_seconds = 5;
  EXPECT_EQ(OutcomeDigest(one), OutcomeDigest(other)) << "said again, with what it used by then";
  other.artifacts = {{"a", "artifacts/1", 1, "text/plain"}};
  EXPECT_NE(OutcomeDigest(one), OutcomeDigest(other));
  one.outcome = AttemptOutcome::kStalled;
  EXPECT_NE(OutcomeDigest(one), OutcomeDigest({}));
}

}  // namespace
}  // namespace poise::jobs
