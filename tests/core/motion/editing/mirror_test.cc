#include "core/motion/editing/mirror.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/motion/joint_pairs.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

// Largest distance between a joint of the mirrored clip and the mirror image of its partner.
double WorstMirrorError(const Clip& clip, const Clip& mirrored, const JointRoles& roles) {
  const std::vector<int> partners = *FindJointPairs(*clip.skeleton(), roles);
  const WorldPoses before = ForwardKinematics(clip), after = ForwardKinematics(mirrored);
  double worst = 0;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      Vec3 image = before.position(frame, partners[joint]);
      image.x() *= -1;
      worst = std::max(worst, (after.position(frame, joint) - image).norm());
    }
  }
  return worst;
}

double WorstRotationDifference(const Clip& a, const Clip& b) {
  double worst = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    for (int joint = 0; joint < a.num_joints(); ++joint) {
      worst = std::max(worst,
                       math::GeodesicDistance(a.rotation(frame, joint), b.rotation(frame, joint)));
    }
  }
  return worst;
}

// The same motion written with other local axes: joint j's frame is turned by turns[j].
Clip WithOtherAxes(const Clip& clip, const std::vector<Quat>& turns) {
  std::vector<Joint> joints = clip.skeleton()->joints();
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].parent >= 0) {
      joints[j].offset = turns[joints[j].parent].conjugate() * joints[j].offset;
    }
    if (joints[j].end_site) joints[j].end_site = turns[j].conjugate() * *joints[j].end_site;
  }
  std::vector<Quat> rotations;
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int j = 0; j < clip.num_joints(); ++j) {
      const Quat local = clip.rotation(frame, j) * turns[j];
      const int parent = clip.skeleton()->parent(j);
      rotations.push_back(parent < 0 ? local : turns[parent].conjugate() * local);
    }
  }
  return *Clip::Create(
      "turned", *Skeleton::Create(std::move(joints)), clip.frame_rate(),
      std::vector<Vec3>(clip.root_positions().begin(), clip.root_positions().end()),
      std::move(rotations));
}

TEST(MirrorTest, PositionsBecomeTheMirrorImage) {
  const Clip clip = testing::SwingingClip(40, 120, 1.0);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip mirrored = *Mirror(clip, roles);
  EXPECT_LT(WorstMirrorError(clip, mirrored, roles), 1e-12);
  EXPECT_GT(WorstMirrorError(clip, clip, roles), 0.1);
}

TEST(MirrorTest, ASymmetricRestPoseFollowsTheRuleOfMotionAug) {
  const Clip clip = testing::SwingingClip(10);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip mirrored = *Mirror(clip, roles);
  const Quat left = clip.rotation(7, *clip.skeleton()->Find("left_knee"));
  const Quat right = mirrored.rotation(7, *clip.skeleton()->Find("right_knee"));
  EXPECT_LT(math::GeodesicDistance(right, Quat(left.w(), left.x(), -left.y(), -left.z())), 1e-15);
}

TEST(MirrorTest, MirroringTwiceGivesTheClipBackBitForBit) {
  const Clip clip = testing::SwingingClip(40, 120, 1.0);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip twice = *Mirror(*Mirror(clip, roles), roles);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    EXPECT_EQ(twice.root_position(frame), clip.root_position(frame));
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      EXPECT_EQ(twice.rotation(frame, joint).coeffs(), clip.rotation(frame, joint).coeffs());
    }
  }
}

TEST(MirrorTest, WorksWhereLeftAndRightLimbsHaveOppositeAxes) {
  // Bones along +X on the left and along -X on the right, trunk along X: no rest pose to speak of.
  const Clip plain = testing::SwingingClip(60, 30, 0.4);
  const Skeleton& skeleton = *plain.skeleton();
  std::vector<Quat> turns(skeleton.num_joints(), math::SwingBetween(Vec3::UnitX(), Vec3::UnitY()));
  for (int j = 1; j < skeleton.num_joints(); ++j) {
    const bool right = skeleton.joint(j).name.starts_with("right_");
    const bool left = skeleton.joint(j).name.starts_with("left_");
    if (!right && !left) continue;
    Vec3 bone = Vec3::UnitX();
    if (!skeleton.children(j).empty()) bone = skeleton.joint(skeleton.children(j)[0]).offset;
    if (left) turns[j] = math::SwingBetween(Vec3::UnitX(), bone);
  }
  // Turn the right frames so that their axes are the left ones seen in the mirror, negated.
  for (int j = 1; j < skeleton.num_joints(); ++j) {
    if (!skeleton.joint(j).name.starts_with("right_")) continue;
    const Quat& left = turns[*skeleton.Find("left_" + skeleton.joint(j).name.substr(6))];
    const math::Mat3 mirrored = Vec3(-1, 1, 1).asDiagonal() * left.toRotationMatrix();
    turns[j] = Quat(math::Mat3(-mirrored));
  }
  const Clip clip = WithOtherAxes(plain, turns);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip mirrored = *Mirror(clip, roles);
  EXPECT_LT(WorstMirrorError(clip, mirrored, roles), 1e-9);
  EXPECT_LT(WorstRotationDifference(*Mirror(mirrored, roles), clip), 1e-9);
  // And it is the motion that the plain skeleton's mirror shows, turn about the bones included.
  const Clip expected = WithOtherAxes(*Mirror(plain, *JointRoles::Detect(skeleton)), turns);
  EXPECT_LT(WorstRotationDifference(mirrored, expected), 1e-9);
}

TEST(MirrorTest, WorksWhereTheRestPoseIsAnySlightlyAskewStance) {
  const Clip plain = testing::SwingingClip(40, 60, 0.8);
  base::Random random(3);
  std::vector<Quat> turns;
  for (int j = 0; j < plain.num_joints(); ++j) {
    turns.push_back(math::FromRotationVector(
        0.15 * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1))));
  }
  const Clip clip = WithOtherAxes(plain, turns);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip mirrored = *Mirror(clip, roles);
  // Bones of the trunk meet the mirror plane only as well as one reflection can do it.
  EXPECT_LT(WorstMirrorError(clip, mirrored, roles), 0.05);
  EXPECT_LT(WorstRotationDifference(*Mirror(mirrored, roles), clip), 1e-9);
}

TEST(MirrorTest, ABodyWithOneLongLegIsRefused) {
  std::vector<Joint> joints = testing::Biped()->joints();
  for (Joint& joint : joints) {
    if (joint.name == "left_ankle") joint.offset *= 1.5;
  }
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  const Clip clip = *Clip::Create("limp", skeleton, 30, {Vec3(0, 1, 0)},
                                  std::vector<Quat>(skeleton->num_joints(), Quat::Identity()));
  const Status status = Mirror(clip, *JointRoles::Detect(*skeleton)).status();
  EXPECT_EQ(base::ErrorReason(status), "ASYMMETRIC_SKELETON");
  EXPECT_NE(base::Message(status).find("ankle"), std::string::npos);
}

TEST(MirrorTest, AThirdArmOnOneSideIsItsOwnPartnerAndRefused) {
  std::vector<Joint> joints = testing::Biped()->joints();
  joints.push_back({"gun", *testing::Biped()->Find("left_wrist"), Vec3(0.1, 0, 0), {}});
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  const Clip clip = *Clip::Create("armed", skeleton, 30, {Vec3(0, 1, 0)},
                                  std::vector<Quat>(skeleton->num_joints(), Quat::Identity()));
  const Status status = Mirror(clip, *JointRoles::Detect(*skeleton)).status();
  EXPECT_EQ(base::ErrorReason(status), "ASYMMETRIC_SKELETON");
  EXPECT_NE(base::Message(status).find("gun"), std::string::npos);
}

}  // namespace
}  // namespace poise::motion
