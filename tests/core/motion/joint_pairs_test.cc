#include "core/motion/joint_pairs.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

// The biped with one more joint on each wrist and one on the chest.
StatusOr<std::vector<int>> PairsWith(const std::string& left, const std::string& right) {
  std::vector<Joint> joints = testing::Biped()->joints();
  joints.push_back({left, *testing::Biped()->Find("left_wrist"), Vec3(0.1, 0, 0), {}});
  joints.push_back({right, *testing::Biped()->Find("right_wrist"), Vec3(-0.1, 0, 0), {}});
  joints.push_back({"lowerneck", *testing::Biped()->Find("chest"), Vec3(0, 0.1, 0), {}});
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  return FindJointPairs(*skeleton, *JointRoles::Detect(*skeleton));
}

TEST(JointPairsTest, RolesComeInPairsAndTheTrunkIsItsOwnPartner) {
  const SkeletonPtr skeleton = testing::Biped();
  const std::vector<int> partners = *FindJointPairs(*skeleton, *JointRoles::Detect(*skeleton));
  EXPECT_EQ(partners[*skeleton->Find("left_knee")], *skeleton->Find("right_knee"));
  EXPECT_EQ(partners[*skeleton->Find("neck")], *skeleton->Find("neck"));
}

TEST(JointPairsTest, OtherJointsArePairedByEveryUsualSpelling) {
  const int count = testing::Biped()->num_joints();
  for (const auto& [left, right] :
       {std::pair("LeftThumb", "RightThumb"), std::pair("Thumb_L", "Thumb_R"),
        std::pair("thumb.l", "thumb.r"), std::pair("lthumb", "rthumb"),
        std::pair("L_Thumb", "R_Thumb"), std::pair("rig:LThumb", "rig:RThumb")}) {
    const auto partners = PairsWith(left, right);
    ASSERT_TRUE(partners.ok()) << left;
    EXPECT_EQ((*partners)[count], count + 1) << left;
    EXPECT_EQ((*partners)[count + 1], count) << left;
    EXPECT_EQ((*partners)[count + 2], count + 2);  // "lowerneck" is no left joint
  }
}

TEST(JointPairsTest, PartnersOnParentsThatAreNoPartnersAreRefused) {
  const Status status = PairsWith("hat", "scarf").status();
  EXPECT_EQ(base::ErrorReason(status), "ASYMMETRIC_SKELETON");
  EXPECT_NE(base::Message(status).find("hat"), std::string::npos);
}

}  // namespace
}  // namespace poise::motion
