#include "core/motion/body_shapes.h"

#include <gtest/gtest.h>

#include "core/motion/rest_pose.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

using enum JointRole;

struct Body {
  SkeletonPtr skeleton = testing::Biped();
  JointRoles roles = *JointRoles::Detect(*skeleton);
  Soles soles = *SolesOfRestPose(*skeleton, roles);
  BodyShapes shapes = *MakeBodyShapes(*skeleton, roles, soles);
  const BodyShape& shape(JointRole role) const { return shapes[static_cast<int>(role)]; }
};

TEST(BodyShapesTest, CapsulesLieInTheMiddleOfTheirBones) {
  const Body body;
  const BodyShape& thigh = body.shape(kLeftHip);
  EXPECT_EQ(thigh.kind, ShapeKind::kCapsule);
  EXPECT_LT((thigh.center - Vec3(0, -0.215, 0)).norm(), 1e-12);
  EXPECT_NEAR((thigh.orientation * Vec3::UnitY()).dot(-Vec3::UnitY()), 1, 1e-12);
  EXPECT_LT(2 * (thigh.half_length + thigh.radius), 0.43);
  EXPECT_EQ(body.skeleton->joint(thigh.joint).name, "left_hip");
}

TEST(BodyShapesTest, RadiiScaleWithTheBodyAndBonesWithThemselves) {
  const Body body;
  std::vector<Joint> joints = body.skeleton->joints();
  for (Joint& joint : joints) {
    joint.offset *= 2;
    if (joint.end_site) *joint.end_site *= 2;
  }
  const SkeletonPtr giant = *Skeleton::Create(std::move(joints));
  const BodyShapes shapes = *MakeBodyShapes(*giant, body.roles, body.soles);
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    EXPECT_NEAR(shapes[i].radius, 2 * body.shapes[i].radius, 1e-12);
    EXPECT_NEAR(shapes[i].half_length, 2 * body.shapes[i].half_length, 1e-12);
    EXPECT_LT((shapes[i].half_extents - 2 * body.shapes[i].half_extents).norm(), 1e-12);
    EXPECT_LT((shapes[i].center - 2 * body.shapes[i].center).norm(), 1e-12);
  }
}

TEST(BodyShapesTest, TheReferenceHumanoidGetsTheReferenceSizes) {
  // A body with MotionAug's limb lengths (sec. 1.6), both sides the mean of left and right.
  std::vector<Joint> joints = testing::Biped()->joints();
  for (Joint& joint : joints) {
    const double length = joint.name.ends_with("knee")    ? (0.3717 + 0.3579) / 2
                          : joint.name.ends_with("ankle") ? (0.3755 + 0.3746) / 2
                          : joint.name.ends_with("elbow") ? (0.2621 + 0.2491) / 2
                          : joint.name.ends_with("wrist") ? (0.1722 + 0.1742) / 2
                                                          : joint.offset.norm();
    if (joint.offset.norm() > 0) joint.offset *= length / joint.offset.norm();
  }
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  EXPECT_NEAR(BodyScale(*skeleton, roles), 1, 1e-12);
  const BodyShapes shapes = *MakeBodyShapes(*skeleton, roles, *SolesOfRestPose(*skeleton, roles));
  const auto diameter = [&](JointRole role) { return 2 * shapes[static_cast<int>(role)].radius; };
  const auto cylinder = [&](JointRole role) {
    return 2 * shapes[static_cast<int>(role)].half_length;
  };
  EXPECT_NEAR(diameter(kChest), 0.165, 1e-12);
  EXPECT_NEAR(diameter(kLeftHip), 0.0825, 1e-12);
  EXPECT_NEAR(cylinder(kLeftHip), 0.225, 1e-3);
  EXPECT_NEAR(cylinder(kLeftKnee), 0.2325, 1e-3);
  EXPECT_NEAR(cylinder(kLeftShoulder), 0.135, 1e-3);
  EXPECT_NEAR(cylinder(kLeftElbow), 0.10125, 1e-3);
}

TEST(BodyShapesTest, TheFootBoxReachesFromHeelToToeTipWithItsSoleBelowTheToes) {
  const Body body;
  const BodyShape& foot = body.shape(kRightAnkle);
  ASSERT_EQ(foot.kind, ShapeKind::kBox);
  EXPECT_LT((foot.orientation * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((foot.orientation * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-12);
  // Toe joint 0.14 in front and 0.06 below the ankle, tip 0.06 further.
  EXPECT_NEAR(foot.center.z() + foot.half_extents.x(), 0.20, 1e-12);
  EXPECT_NEAR(foot.center.z() - foot.half_extents.x(), -0.35 * 0.14, 1e-12);
  EXPECT_NEAR(foot.center.y(), -0.06, 1e-12);
}

TEST(BodyShapesTest, AFootWithoutToesIsEstimatedFromTheShin) {
  std::vector<Joint> joints = testing::Biped()->joints();
  for (Joint& joint : joints) {
    if (joint.name.ends_with("toe")) joint.name += "_ornament";  // no role any more
  }
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  const Soles soles = *SolesOfRestPose(*skeleton, roles);
  EXPECT_LT((soles.left.forward - Vec3::UnitZ()).norm(), 1e-12);
  const BodyShape foot = (*MakeBodyShapes(*skeleton, roles, soles))[static_cast<int>(kLeftAnkle)];
  EXPECT_NEAR(foot.center.y() - foot.half_extents.y(), -0.18 * 0.42, 1e-12);
  EXPECT_NEAR(foot.center.z() + foot.half_extents.x(), 0.33 * 0.42 * 1.35, 1e-12);
}

TEST(RestPoseTest, BonesAlongOneAxisDoNotStand) {
  const Body body;
  EXPECT_TRUE(RestPoseStands(*body.skeleton, body.roles));
  std::vector<Joint> joints = body.skeleton->joints();
  for (Joint& joint : joints) joint.offset = Vec3(joint.offset.norm(), 0, 0);
  const SkeletonPtr line = *Skeleton::Create(std::move(joints));
  EXPECT_FALSE(RestPoseStands(*line, body.roles));
  EXPECT_FALSE(SolesOfRestPose(*line, body.roles).has_value());
  EXPECT_NEAR(LegLength(*line, body.roles), 0.85, 1e-12);
}

TEST(RestPoseTest, VectorsAddUpOverJointsBetween) {
  const Body body;
  EXPECT_LT((RestVector(*body.skeleton, body.roles, kPelvis, kNeck) - Vec3(0, 0.51, 0)).norm(),
            1e-12);
  EXPECT_TRUE(RestVector(*body.skeleton, body.roles, kNeck, kPelvis).isZero());
}

}  // namespace
}  // namespace poise::motion
