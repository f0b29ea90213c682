#include "core/motion/joint_roles.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

SkeletonPtr Chain(std::vector<std::string> names) {
  std::vector<Joint> joints;
  for (std::string& name : names) {
    joints.push_back({std::move(name), static_cast<int>(joints.size()) - 1, Vec3(0, 0.1, 0), {}});
  }
  return *Skeleton::Create(std::move(joints));
}

TEST(JointRolesTest, FindsEveryRoleByItsOwnName) {
  const auto skeleton = testing::Biped();
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  EXPECT_TRUE(roles.missing().empty());
  EXPECT_TRUE(roles.RequireComplete().ok());
  EXPECT_EQ(skeleton->joint(roles.joint(JointRole::kLeftToe)).name, "left_toe");
}

TEST(JointRolesTest, MixamoChestIsTheJointThatCarriesTheArms) {
  const auto skeleton =
      Chain({"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2",
             "mixamorig:Neck", "mixamorig:Head", "mixamorig:LeftShoulder", "mixamorig:LeftArm",
             "mixamorig:LeftToeBase"});
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  EXPECT_EQ(roles.joint(JointRole::kChest), 3);
  EXPECT_EQ(roles.joint(JointRole::kLeftShoulder), 7);
  EXPECT_EQ(roles.joint(JointRole::kLeftToe), 8);
}

TEST(JointRolesTest, MissingRolesAreListedWithTheWayToMapThem) {
  const JointRoles roles = *JointRoles::Detect(*Chain({"Hips", "Spine", "Bogus"}));
  const Status status = roles.RequireComplete();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_NE(base::Message(status).find("left_hip"), std::string::npos);
  EXPECT_NE(base::Message(status).find("--roles"), std::string::npos);
  EXPECT_NE(base::Message(status).find("Bogus"), std::string::npos);
}

TEST(JointRolesTest, OverridesWinAndBadOnesAreRefused) {
  const auto skeleton = Chain({"Hips", "Spine", "Bogus"});
  EXPECT_EQ(JointRoles::Detect(*skeleton, {{"chest", "Bogus"}})->joint(JointRole::kChest), 2);
  EXPECT_EQ(base::ErrorReason(JointRoles::Detect(*skeleton, {{"tail", "Bogus"}}).status()),
            "UNKNOWN_ROLE");
  EXPECT_EQ(base::ErrorReason(JointRoles::Detect(*skeleton, {{"chest", "Bogas"}}).status()),
            "UNKNOWN_JOINT");
}

TEST(JointRolesTest, MirroringARoleTwiceGivesItBack) {
  for (int i = 0; i < kNumRoles; ++i) {
    const auto role = static_cast<JointRole>(i);
    EXPECT_EQ(MirrorRole(MirrorRole(role)), role);
  }
  EXPECT_EQ(MirrorRole(JointRole::kLeftKnee), JointRole::kRightKnee);
  EXPECT_EQ(MirrorRole(JointRole::kNeck), JointRole::kNeck);
}

}  // namespace
}  // namespace poise::motion
