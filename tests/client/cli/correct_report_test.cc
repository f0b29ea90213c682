#include "client/cli/correct_report.h"

#include <gmock/gmock.h>

namespace poise::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

api::CorrectedVariantReport Variant(int index, double reward, double force) {
  api::CorrectedVariantReport variant;
  variant.file = "kick_ik_00" + std::to_string(index) + ".bvh";
  variant.index = index;
  variant.completed = true;
  variant.effort = "fast";
  variant.before.foot_skate_mps = 0.08;
  variant.after.emplace();
  variant.after->plausibility.foot_skate_mps = 0.04 + 0.02 * index;
  variant.after->score.reward_normalised = reward;
  variant.after->score.residual_force_mean_bw = force;
  return variant;
}

CorrectedClip Clip() {
  CorrectedClip clip{.name = "kick", .job = {}, .report = api::CorrectedClipReport()};
  clip.job.id = "019abc";
  clip.job.state = api::JobState::kSucceeded;
  clip.job.start_time = absl::UnixEpoch();
  clip.job.end_time = absl::UnixEpoch() + absl::Milliseconds(1500);
  clip.report->name = "kick";
  clip.report->stopped_by = "finished";
  clip.report->variants = {Variant(0, 0.9, 0.05), Variant(1, 0.7, 0.15)};
  return clip;
}

TEST(CorrectReportTest, JsonHasTheFixedFieldsAndFilesWithTheirFolder) {
  const base::Json json = CorrectedClipJson(Clip(), "out");
  for (const char* key : {"job", "state", "wall_s", "samples", "stopped_by", "zero_policy",
                          "reward_curve", "variants"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["job"], "jobs/019abc");
  EXPECT_EQ(json["state"], "SUCCEEDED");
  EXPECT_EQ(json["wall_s"], 1.5);
  EXPECT_EQ(json["variants"][1]["file"], "out/kick_ik_001.bvh");
  EXPECT_TRUE(json["error"].is_null());
}

TEST(CorrectReportTest, AJobThatFailedHasItsErrorAndNulls) {
  CorrectedClip clip = Clip();
  clip.report.reset();
  clip.job.state = api::JobState::kFailed;
  clip.job.error = api::JobError{absl::StatusCode::kInvalidArgument, "MALFORMED_BVH", "line 3", ""};
  const base::Json json = CorrectedClipJson(clip, "out");
  EXPECT_EQ(json["error"]["reason"], "MALFORMED_BVH");
  EXPECT_TRUE(json["variants"].is_null());
}

TEST(CorrectReportTest, TheTablesHaveMeansAndTheWorst) {
  const std::string text = CorrectionText({Clip()});
  EXPECT_THAT(text, HasSubstr("kick, 2 variants before"));
  EXPECT_THAT(text, HasSubstr("2/2   0.800     0.100")) << "means of reward and force";
  EXPECT_THAT(text, HasSubstr("0.700     0.150")) << "the worst of each";
  EXPECT_THAT(text, Not(HasSubstr("not completed")));
}

TEST(CorrectReportTest, WhatFellAndWhatEndedEarlyIsSaid) {
  CorrectedClip clip = Clip();
  clip.report->stopped_by = "max_seconds";
  clip.report->variants[0].completed = false;
  clip.report->variants[0].after->score.completion = 0.42;
  api::CorrectedVariantReport& none = clip.report->variants[1];
  none.completed = false;
  none.after.reset();
  none.error = api::JobError{absl::StatusCode::kOutOfRange, "DIVERGED", "it flew away", ""};
  const std::string text = CorrectionText({clip});
  EXPECT_THAT(text, HasSubstr("variant 0 was not completed: it failed after 42 %"));
  EXPECT_THAT(text, HasSubstr("variant 1 could not be corrected: it flew away"));
  EXPECT_THAT(text, HasSubstr("stopped by max_seconds"));
  EXPECT_THAT(text, HasSubstr("0/2"));
}

}  // namespace
}  // namespace poise::cli
