#include "client/cli/augment_report.h"

#include <gmock/gmock.h>

namespace poise::cli {
namespace {

using ::testing::HasSubstr;

api::DeliveredVariant Variant(int index, double skate_mps, bool reachable) {
  motion::Plausibility plausibility;
  plausibility.foot_skate_mps = skate_mps;
  api::IkOutcome ik;
  ik.target = motion::Vec3(0.5, 1, 2);
  ik.reached_error_m = reachable ? 0.0004 : 0.2;
  ik.reachable = reachable;
  return {.source_index = 0,
          .index = index,
          .seed = 18446744073709551615u,
          .result = std::string("artifacts/x"),
          .ik = ik,
          .plausibility = plausibility};
}

TEST(AugmentReportTest, AJsonLineHasTheFixedFields) {
  EXPECT_EQ(VariantJson(Variant(3, 0.5, true), "in/kick.bvh", "out/kick_ik_003.bvh", "ik").dump(),
            R"({"index":3,"source":"in/kick.bvh","file":"out/kick_ik_003.bvh",)"
            R"("seed":18446744073709551615,"method":"ik","target_m":[0.5,1.0,2.0],)"
            R"("reached_error_m":0.0004,"reachable":true,"plausibility":{"foot_skate_mps":0.5,)"
            R"("penetration_mean_m":0.0,"penetration_max_m":0.0,"float_mean_m":0.0,)"
            R"("self_penetration_max_m":0.0,"acceleration_rms_mps2":0.0,"jerk_rms_mps3":0.0}})");
}

TEST(AugmentReportTest, AVariantWithoutIkHasNulls) {
  api::DeliveredVariant variant = Variant(0, 0, true);
  variant.ik.reset();
  const base::Json json = VariantJson(variant, "a", "b", "noise");
  EXPECT_TRUE(json.at("target_m").is_null());
  EXPECT_TRUE(json.at("reachable").is_null());
}

TEST(AugmentReportTest, TheTableHasSourceMeanAndWorst) {
  motion::Plausibility source;
  source.foot_skate_mps = 0.1;
  AugmentReport report({{.name = "kick", .plausibility = source}});
  report.Add(Variant(0, 0.2, true));
  report.Add(Variant(1, 0.4, false));
  const std::string text = report.Text();
  EXPECT_THAT(text, HasSubstr("foot skate cm/s"));
  EXPECT_THAT(text, ::testing::ContainsRegex("kick, source +10.0 "));
  EXPECT_THAT(text, ::testing::ContainsRegex("2 variants, mean +30.0 "));
  EXPECT_THAT(text, ::testing::ContainsRegex("worst +40.0 "));
  EXPECT_THAT(text, HasSubstr("1 of 2 targets within reach, missed by at most 0.40 mm"));
  EXPECT_THAT(text, HasSubstr("1 of 2 targets out of reach, approached to 20.0 cm on average"));
}

}  // namespace
}  // namespace poise::cli
