#include <gtest/gtest.h>

#include <algorithm>

#include "core/motion/io/clip_file.h"
#include "core/motion/metrics/plausibility.h"
#include "tests/support/data_files.h"

namespace poise::motion {
namespace {

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(PlausibilityOnRealClipsTest, HdmKicksLookLikePeopleOnAFloor) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  std::vector<double> skate, penetration, floating, self, acceleration, jerk;
  for (const auto& file : testing::DataFiles("hdm05/kickLFront1Reps", {".amc"})) {
    const Clip clip = ReadClipFile(file)->clip;
    const Plausibility result = *AssessPlausibility(clip, *JointRoles::Detect(*clip.skeleton()));
    skate.push_back(result.foot_skate_mps);
    penetration.push_back(result.penetration_mean_m);
    floating.push_back(result.float_mean_m);
    self.push_back(result.self_penetration_max_m);
    acceleration.push_back(result.acceleration_rms_mps2);
    jerk.push_back(result.jerk_rms_mps3);
  }
  std::printf(
      "median of %zu kicks: skate %.3f m/s, penetration %.4f m, float %.4f m, self %.4f m, "
      "acceleration %.1f m/s^2, jerk %.0f m/s^3\n",
      skate.size(), Median(skate), Median(penetration), Median(floating), Median(self),
      Median(acceleration), Median(jerk));
  EXPECT_LT(Median(skate), 0.3);
  EXPECT_LT(Median(penetration), 0.01);
  EXPECT_LT(Median(floating), 0.01);
  EXPECT_LT(Median(self), 0.01);
  EXPECT_GT(Median(acceleration), 5);
  EXPECT_LT(Median(acceleration), 40);
}

TEST(PlausibilityOnRealClipsTest, HopsFloatAndStandingPeopleDoNot) {
  POISE_REQUIRE_DATA("hdm05/hopBothLegs1hops");
  POISE_REQUIRE_DATA("hdm05/rotateArmsBothBackward1Reps");
  const auto median_float = [](const std::string& folder) {
    std::vector<double> values;
    for (const auto& file : testing::DataFiles(folder, {".amc"})) {
      const Clip clip = ReadClipFile(file)->clip;
      values.push_back(
          AssessPlausibility(clip, *JointRoles::Detect(*clip.skeleton()))->float_mean_m);
    }
    return Median(values);
  };
  EXPECT_GT(median_float("hdm05/hopBothLegs1hops"), 0.04);
  EXPECT_LT(median_float("hdm05/rotateArmsBothBackward1Reps"), 0.002);
}

}  // namespace
}  // namespace poise::motion
