#include "samples/author/limb.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poise::samples {
namespace {

using math::Quat;
using math::Vec3;

constexpr double kUpper = 0.4;
constexpr double kLower = 0.3;

Vec3 End(const Vec3& base, const LimbPose& pose) {
  return base + kUpper * pose.upper + kLower * pose.Lower();
}

TEST(LimbTest, ReachesEveryGoalInReachWithTheHingeOnTheSideOfThePole) {
  const Vec3 base(0.1, 0.9, -0.2);
  const Vec3 pole(0.2, 0.1, 1);
  for (const double distance : {0.15, 0.3, 0.5, 0.69}) {
    for (const Vec3& direction : {Vec3(0, -1, 0), Vec3(1, -1, 0.5), Vec3(-0.3, 0.2, -1)}) {
      const Vec3 goal = base + distance * direction.normalized();
      const LimbPose pose = ReachGoal(base, goal, pole, kUpper, kLower);
      EXPECT_LT((End(base, pose) - goal).norm(), 1e-12);
      EXPECT_GT(pose.flexion, 0);
      const Vec3 bend =
          pose.upper - direction.normalized().dot(pose.upper) * direction.normalized();
      EXPECT_GT(bend.dot(pole), 0);
    }
  }
}

TEST(LimbTest, StretchesTowardsAGoalOutOfReach) {
  const LimbPose pose = ReachGoal(Vec3::Zero(), Vec3(0, -3, 0), Vec3(0, 0, 1), kUpper, kLower);
  EXPECT_NEAR(End(Vec3::Zero(), pose).y(), -0.999 * (kUpper + kLower), 1e-12);
}

TEST(LimbTest, BlendEndsAtItsInputs) {
  const LimbPose a = ReachGoal(Vec3::Zero(), Vec3(0, -0.5, 0), Vec3(0, 0, 1), kUpper, kLower);
  const LimbPose b = ReachGoal(Vec3::Zero(), Vec3(0, -0.2, 0.5), Vec3(0.3, 0, 1), kUpper, kLower);
  EXPECT_LT((End(Vec3::Zero(), Blend(a, b, 0)) - Vec3(0, -0.5, 0)).norm(), 1e-12);
  EXPECT_LT((End(Vec3::Zero(), Blend(a, b, 1)) - Vec3(0, -0.2, 0.5)).norm(), 1e-12);
}

TEST(LimbTest, TurnBoneLaysBoneAndHingeWhereAsked) {
  const Vec3 bone = Vec3(1, -2, 0.5).normalized();
  const Vec3 hinge = bone.cross(Vec3(0, 0.3, 1)).normalized();
  const Quat turn = TurnBone(-Vec3::UnitY(), Vec3::UnitX(), bone, hinge);
  EXPECT_LT((turn * -Vec3::UnitY() - bone).norm(), 1e-12);
  EXPECT_LT((turn * Vec3::UnitX() - hinge).norm(), 1e-12);
}

}  // namespace
}  // namespace poise::samples
