#include "client/cli/jobs/job_text.h"

#include <gmock/gmock.h>

namespace poise::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

api::Job RunningJob() {
  api::Job job;
  job.id = "01";
  job.state = api::JobState::kRunning;
  job.spec.kind = "selftest";
  job.attempt = 2;
  job.progress = {.step = 5, .total = 10, .message = "", .metrics = {{"eta_s", 65.2}}};
  job.create_time = absl::FromUnixSeconds(1000);
  return job;
}

TEST(JobTextTest, ProgressIsABarWithWhatIsLeft) {
  EXPECT_EQ(ProgressText(RunningJob().progress), "[##########..........]  5/10  1:05 left");
  EXPECT_EQ(ProgressText({.step = 7, .total = 0, .message = ""}), "step 7");
  EXPECT_EQ(ProgressText({}), "");
}

TEST(JobTextTest, ProgressOutOfBoundsDoesNotLeaveTheBar) {
  EXPECT_EQ(ProgressText({.step = 30, .total = 10, .message = ""}),
            "[####################]  30/10");
  EXPECT_EQ(ProgressText({.step = -3, .total = 10, .message = ""}),
            "[....................]  -3/10");
  EXPECT_THAT(ProgressText({.step = INT64_MAX, .total = INT64_MAX, .message = ""}),
              HasSubstr("####"));
}

TEST(JobTextTest, ALineTellsStateProgressAndWhyItIsNotTheFirstAttempt) {
  api::Job job = RunningJob();
  EXPECT_EQ(JobLine(job), "jobs/01  RUNNING  [##########..........]  5/10  1:05 left  attempt 2");
  job.state = api::JobState::kQueued;
  job.error = api::JobError{absl::StatusCode::kUnavailable, "LOST", "its worker vanished", ""};
  EXPECT_THAT(JobLine(job), HasSubstr("QUEUED again"));
  EXPECT_THAT(JobLine(job), HasSubstr("its worker vanished (LOST)"));
}

TEST(JobTextTest, TheTableHasARowForEachJobWithItsAge) {
  const std::string table = JobTable({RunningJob(), RunningJob()}, absl::FromUnixSeconds(1042));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_THAT(table, HasSubstr("42 s"));
}

TEST(JobTextTest, DetailsLeaveOutWhatThereIsNot) {
  api::Job job = RunningJob();
  EXPECT_THAT(JobDetails(job), Not(HasSubstr("ended")));
  EXPECT_THAT(JobDetails(job), Not(HasSubstr("outcome")));
  job.attempts.push_back({.attempt = 1, .worker = "w1", .outcome = api::AttemptOutcome::kLost});
  EXPECT_THAT(JobDetails(job), HasSubstr("LOST"));
}

TEST(JobTextTest, DurationsHaveTheUnitThatFits) {
  EXPECT_EQ(DurationText(absl::Seconds(3)), "3.0 s");
  EXPECT_EQ(DurationText(absl::Minutes(12)), "12 min");
  EXPECT_EQ(DurationText(absl::Hours(5)), "5 h");
  EXPECT_EQ(DurationText(absl::Hours(24 * 9)), "9 d");
  EXPECT_EQ(DurationText(-absl::Seconds(1)), "0.0 s") << "clocks differ between machines";
}

}  // namespace
}  // namespace poise::cli
