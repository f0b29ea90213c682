#include "client/cli/jobs/job_json.h"

#include <gtest/gtest.h>

namespace poise::cli {
namespace {

TEST(JobJsonTest, AJobHasEveryFieldThatScriptsRelyOn) {
  api::Job job;
  job.id = "01";
  job.state = api::JobState::kFailed;
  job.spec.kind = "selftest";
  job.error = api::JobError{absl::StatusCode::kOutOfRange, "DIVERGED", "it did", "x"};
  job.progress = {.step = 5, .total = 10, .message = "", .metrics = {{"reward", 0.5}}};
  job.attempts.push_back({.attempt = 1, .worker = "w1", .outcome = api::AttemptOutcome::kError});
  const base::Json json = JobJson(job);
  for (const char* field :
       {"name", "kind", "state", "request_id", "attempt", "losses", "errors", "attempts"}) {
    EXPECT_TRUE(json.contains(field)) << field;
  }
  EXPECT_EQ(json["name"], "jobs/01");
  EXPECT_EQ(json["state"], "FAILED");
  EXPECT_EQ(json["error"]["reason"], "DIVERGED");
  EXPECT_EQ(json["error"]["code"], "OUT_OF_RANGE");
  EXPECT_EQ(json["progress"]["reward"], 0.5);
  EXPECT_TRUE(json["progress"]["samples"].is_null());
  EXPECT_TRUE(json["progress"]["eta_s"].is_null());
  EXPECT_EQ(json["attempts"][0]["outcome"], "ERROR");
  EXPECT_TRUE(json["attempts"][0]["end_time"].is_null());
  EXPECT_TRUE(JobJson({})["error"].is_null());
}

TEST(JobJsonTest, AnEventHasWhatHappenedAndNothingElse) {
  api::JobEvent event{.seq = 3, .time = absl::UnixEpoch(), .attempt = 1};
  event.state = api::JobState::kRunning;
  base::Json json = EventJson("01", event);
  EXPECT_EQ(json["state"], "RUNNING");
  EXPECT_EQ(json["time"], "1970-01-01T00:00:00.000Z");
  EXPECT_FALSE(json.contains("progress"));
  event.state.reset();
  event.progress = base::Progress{.step = 1, .total = 2, .message = ""};
  json = EventJson("01", event);
  EXPECT_EQ(json["progress"]["step"], 1);
  EXPECT_FALSE(json.contains("state"));
}

}  // namespace
}  // namespace poise::cli
