#include "core/api/correction_report.h"

#include <gtest/gtest.h>

namespace poise::api {
namespace {

using base::Json;

CorrectedClipReport Report() {
  CorrectedVariantReport fell;
  fell.file = "kick_ik_000.bvh";
  fell.seed = 18446744073709551615u;
  fell.before.foot_skate_mps = 0.1;
  fell.after.emplace();
  fell.after->score.completion = 1 / 3.0;
  fell.after->score.reward_normalised = 0.3;
  CorrectedVariantReport none;
  none.index = 1;
  none.error = JobError{absl::StatusCode::kOutOfRange, "DIVERGED", "the body flew away", ""};
  return {.name = "kick",
          .samples = 123,
          .stopped_by = "finished",
          .zero_policy = ZeroPolicyReport{.completed = true, .measures = {}},
          .reward_curve = {{.samples = 100, .reward_normalised = 0.1 + 0.2}},
          .variants = {fell, none}};
}

TEST(CorrectionReportTest, JsonHasTheFixedNames) {
  const Json json = ToJson(Report());
  for (const char* key : {"samples", "stopped_by", "zero_policy", "reward_curve", "variants"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  const Json& variant = json["variants"][0];
  const std::vector<std::string> looks = {
      "foot_skate_mps",         "penetration_mean_m",    "penetration_max_m", "float_mean_m",
      "self_penetration_max_m", "acceleration_rms_mps2", "jerk_rms_mps3"};
  for (const std::string& name : looks) {
    EXPECT_TRUE(variant["before"].contains(name)) << name;
    EXPECT_TRUE(variant["after"].contains(name)) << name;
  }
  for (const char* name :
       {"residual_force_mean_bw", "residual_force_peak_bw", "residual_torque_mean_nm",
        "torque_saturation", "completion", "reward_imitation", "reward_normalised", "reward_total",
        "pose_error_rad", "pose_error_m"}) {
    EXPECT_TRUE(variant["after"].contains(name)) << name;
    EXPECT_TRUE(json["zero_policy"].contains(name)) << name;
    EXPECT_FALSE(variant["before"].contains(name)) << name;
  }
  EXPECT_TRUE(json["variants"][1]["file"].is_null());
  EXPECT_TRUE(json["variants"][1]["after"].is_null());
  EXPECT_EQ(json["variants"][1]["error"]["reason"], "DIVERGED");
}

TEST(CorrectionReportTest, JsonKeepsEveryBit) {
  const std::string text = ToJson(Report()).dump();
  const auto back = CorrectedClipFromJson(Json::parse(text));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->variants[0].after->score.completion, 1 / 3.0);
  EXPECT_EQ(back->variants[0].seed, 18446744073709551615u);
  EXPECT_EQ(back->reward_curve[0].reward_normalised, 0.1 + 0.2);
  EXPECT_FALSE(back->variants[1].after.has_value());
  Json again = ToJson(*back);
  again["variants"][1]["error"]["code"] = "OUT_OF_RANGE";  // a code is for people
  EXPECT_EQ(again.dump(), text);
}

TEST(CorrectionReportTest, WhatIsNoReportIsAnError) {
  for (const char* text : {"{}", "[]", "3", R"({"name": 3})"}) {
    const Status status = CorrectedClipFromJson(Json::parse(text)).status();
    EXPECT_EQ(base::ErrorReason(status), "MALFORMED_REPORT") << text;
  }
  Json json = ToJson(Report());
  json["variants"][0]["before"]["foot_skate_mps"] = "much";
  EXPECT_FALSE(CorrectedClipFromJson(json).ok());
}

}  // namespace
}  // namespace poise::api
