#include "core/motion/metrics/plausibility.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/motion/kinematics/sole_estimate.h"
#include "core/motion/metrics/placed_bodies.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

// The biped in its rest pose, carried along a path.
Clip Carried(int frames, double rate, const std::function<Vec3(int)>& position) {
  const SkeletonPtr skeleton = testing::Biped();
  std::vector<Vec3> positions;
  for (int frame = 0; frame < frames; ++frame) positions.push_back(position(frame));
  return *Clip::Create(
      "carried", skeleton, rate, std::move(positions),
      std::vector<Quat>(static_cast<size_t>(frames) * skeleton->num_joints(), Quat::Identity()));
}

Plausibility Assess(const Clip& clip) {
  return *AssessPlausibility(clip, *JointRoles::Detect(*clip.skeleton()));
}

TEST(PlausibilityTest, ABodyThatStandsStillHasNoFaults) {
  const Plausibility result = Assess(Carried(60, 120, [](int) { return Vec3(3, 0.7, -2); }));
  EXPECT_NEAR(result.foot_skate_mps, 0, 1e-12);
  EXPECT_NEAR(result.penetration_max_m, 0, 1e-12);
  EXPECT_NEAR(result.penetration_mean_m, 0, 1e-12);
  EXPECT_NEAR(result.float_mean_m, 0, 1e-12);
  EXPECT_EQ(result.self_penetration_max_m, 0);
  EXPECT_NEAR(result.acceleration_rms_mps2, 0, 1e-9);
  EXPECT_NEAR(result.jerk_rms_mps3, 0, 1e-6);
}

TEST(PlausibilityTest, AKnownFloorIsNotEstimated) {
  const Clip clip = Carried(60, 120, [](int) { return Vec3(3, 0.7, -2); });
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const WorldPoses world = ForwardKinematics(clip);
  const BodyShapes shapes =
      *MakeBodyShapes(*clip.skeleton(), roles, EstimateSoles(*clip.skeleton(), roles, world));
  PlacedBodies bodies;
  PlaceBodies(shapes, world, bodies);
  const double lowest = bodies.lowest[0];
  const Plausibility below = *AssessPlausibility(clip, shapes, lowest + 0.05);
  EXPECT_NEAR(below.penetration_mean_m, 0.05, 1e-12);
  EXPECT_NEAR(below.penetration_max_m, 0.05, 1e-12);
  EXPECT_EQ(below.float_mean_m, 0);
  const Plausibility above = *AssessPlausibility(clip, shapes, lowest - 0.03);
  EXPECT_NEAR(above.float_mean_m, 0.03, 1e-12);
  EXPECT_EQ(above.penetration_max_m, 0);
}

TEST(PlausibilityTest, ABodyThatSlidesAtOneMetrePerSecondSkatesAtThatSpeed) {
  const Plausibility result = Assess(
      Carried(120, 120, [](int frame) { return Vec3(0.6 * frame / 120, 0, 0.8 * frame / 120); }));
  EXPECT_NEAR(result.foot_skate_mps, 1, 1e-9);
  EXPECT_NEAR(result.penetration_max_m, 0, 1e-12);
  EXPECT_NEAR(result.float_mean_m, 0, 1e-12);
}

TEST(PlausibilityTest, TwentyLoweredFramesOfAHundredPenetrateByThatDepth) {
  const Plausibility result = Assess(Carried(
      100, 120, [](int frame) { return Vec3(0, frame >= 40 && frame < 60 ? 0.95 : 1.0, 0); }));
  EXPECT_NEAR(result.penetration_max_m, 0.05, 1e-12);
  EXPECT_NEAR(result.penetration_mean_m, 0.01, 1e-12);
  EXPECT_NEAR(result.float_mean_m, 0, 1e-12);
}

TEST(PlausibilityTest, AJumpFloatsByItsMeanHeightAndDoesNotMoveTheFloor) {
  // In the air for 60 of 200 frames on a parabola; its mean height is summed here by hand.
  double sum = 0;
  const auto height = [](int frame) {
    if (frame < 70 || frame >= 130) return 0.0;
    const double u = (frame - 99.5) / 30.5;
    return 0.4 * (1 - u * u);
  };
  for (int frame = 0; frame < 200; ++frame) sum += height(frame);
  const Plausibility result =
      Assess(Carried(200, 120, [&](int frame) { return Vec3(0, 1 + height(frame), 0); }));
  EXPECT_NEAR(result.float_mean_m, sum / 200, 1e-12);
  EXPECT_NEAR(result.penetration_max_m, 0, 1e-12);
  EXPECT_NEAR(result.foot_skate_mps, 0, 1e-12);
}

TEST(PlausibilityTest, WhereTheClipStandsInTheWorldDoesNotMatter) {
  const Clip clip = testing::SwingingClip(120);
  Clip moved = clip;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    moved.root_position(frame) += Vec3(10, -3, 4);
  }
  const base::Json here = ToJson(Assess(clip)), there = ToJson(Assess(moved));
  for (const auto& [key, value] : here.items()) {
    EXPECT_NEAR(value.get<double>(), there[key].get<double>(), 1e-6) << key;
  }
}

TEST(PlausibilityTest, JsonHasTheSevenFixedNames) {
  const base::Json json = ToJson(Plausibility{});
  EXPECT_EQ(json.size(), 7u);
  for (const char* name :
       {"foot_skate_mps", "penetration_mean_m", "penetration_max_m", "float_mean_m",
        "self_penetration_max_m", "acceleration_rms_mps2", "jerk_rms_mps3"}) {
    EXPECT_TRUE(json.contains(name)) << name;
  }
}

TEST(PlausibilityTest, ShortClipsAndBodiesWithoutRolesAreRefused) {
  const Clip clip = Carried(3, 30, [](int) { return Vec3(0, 1, 0); });
  EXPECT_EQ(
      base::ErrorReason(AssessPlausibility(clip, *JointRoles::Detect(*clip.skeleton())).status()),
      "CLIP_TOO_SHORT");
  const SkeletonPtr stick = *Skeleton::Create({{"stick", -1, Vec3::Zero(), {}}});
  const Clip still = *Clip::Create("stick", stick, 30, std::vector<Vec3>(9, Vec3::Zero()),
                                   std::vector<Quat>(9, Quat::Identity()));
  EXPECT_EQ(base::ErrorReason(AssessPlausibility(still, *JointRoles::Detect(*stick)).status()),
            "MISSING_ROLES");
}

TEST(PlausibilityTest, ASettingOutOfRangeIsNamed) {
  const Clip clip = testing::SwingingClip(10);
  const Status status =
      AssessPlausibility(clip, *JointRoles::Detect(*clip.skeleton()), {.contact_height_m = -1})
          .status();
  EXPECT_EQ(base::ErrorReason(status), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(base::ErrorField(status), "contact_height_m");
}

}  // namespace
}  // namespace poise::motion
