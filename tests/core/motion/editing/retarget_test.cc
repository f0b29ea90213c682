#include "core/motion/editing/retarget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "core/base/random.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/motion/rest_pose.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

using enum JointRole;

constexpr std::pair<JointRole, JointRole> kLimbBones[] = {
    {kLeftHip, kLeftKnee},       {kLeftKnee, kLeftAnkle},  {kLeftAnkle, kLeftToe},
    {kLeftShoulder, kLeftElbow}, {kLeftElbow, kLeftWrist}, {kRightHip, kRightKnee},
    {kRightKnee, kRightAnkle},   {kRightAnkle, kRightToe}, {kRightShoulder, kRightElbow},
    {kRightElbow, kRightWrist}};

// Largest angle between a limb bone in one clip and in the other [rad].
double WorstBoneAngle(const Clip& a, const JointRoles& roles_a, const Clip& b,
                      const JointRoles& roles_b) {
  const WorldPoses world_a = ForwardKinematics(a), world_b = ForwardKinematics(b);
  double worst = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    for (const auto& [from, to] : kLimbBones) {
      const Vec3 u =
          world_a.position(frame, roles_a.joint(to)) - world_a.position(frame, roles_a.joint(from));
      const Vec3 v =
          world_b.position(frame, roles_b.joint(to)) - world_b.position(frame, roles_b.joint(from));
      worst = std::max(worst, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return worst;
}

SkeletonPtr Changed(const Skeleton& skeleton, const std::function<void(Joint&)>& change) {
  std::vector<Joint> joints = skeleton.joints();
  for (Joint& joint : joints) change(joint);
  return *Skeleton::Create(std::move(joints));
}

class RetargetTest : public ::testing::Test {
 protected:
  const Clip clip_ = testing::SwingingClip(60, 60, 0.5);
  const JointRoles roles_ = *JointRoles::Detect(*clip_.skeleton());
};

TEST_F(RetargetTest, ToTheSameSkeletonIsTheIdentity) {
  const Clip same = *Retarget(clip_, roles_, clip_.skeleton(), roles_);
  for (int frame = 0; frame < clip_.num_frames(); ++frame) {
    EXPECT_LT((same.root_position(frame) - clip_.root_position(frame)).norm(), 1e-9);
    for (int joint = 0; joint < clip_.num_joints(); ++joint) {
      EXPECT_LT(math::GeodesicDistance(same.rotation(frame, joint), clip_.rotation(frame, joint)),
                1e-7);
    }
  }
}

TEST_F(RetargetTest, AScaledBodyMovesThroughScaledPositions) {
  const SkeletonPtr child = Changed(*clip_.skeleton(), [](Joint& joint) {
    joint.offset *= 0.6;
    if (joint.end_site) *joint.end_site *= 0.6;
  });
  const Clip small = *Retarget(clip_, roles_, child, roles_);
  const WorldPoses before = ForwardKinematics(clip_), after = ForwardKinematics(small);
  for (size_t i = 0; i < before.positions.size(); ++i) {
    EXPECT_LT((after.positions[i] - 0.6 * before.positions[i]).norm(), 1e-9);
  }
}

TEST_F(RetargetTest, OtherProportionsKeepTheDirectionsOfLimbs) {
  base::Random random(8);
  const SkeletonPtr other =
      Changed(*clip_.skeleton(), [&](Joint& joint) { joint.offset *= random.Uniform(0.7, 1.3); });
  const Clip out = *Retarget(clip_, roles_, other, roles_);
  EXPECT_LT(WorstBoneAngle(clip_, roles_, out, roles_), 1e-6);
}

TEST_F(RetargetTest, AnotherRestPoseAndOtherNamesKeepTheDirectionsOfLimbs) {
  // Arms hang, legs are splayed, the body faces -X and has Mixamo's names without a toe's end.
  const std::map<std::string, std::string> names = {{"pelvis", "Hips"},
                                                    {"spine", "Spine"},
                                                    {"chest", "Spine2"},
                                                    {"neck", "Neck"},
                                                    {"head", "Head"},
                                                    {"left_hip", "LeftUpLeg"},
                                                    {"left_knee", "LeftLeg"},
                                                    {"left_ankle", "LeftFoot"},
                                                    {"left_toe", "LeftToeBase"},
                                                    {"left_collar", "LeftShoulder"},
                                                    {"left_shoulder", "LeftArm"},
                                                    {"left_elbow", "LeftForeArm"},
                                                    {"left_wrist", "LeftHand"},
                                                    {"right_hip", "RightUpLeg"},
                                                    {"right_knee", "RightLeg"},
                                                    {"right_ankle", "RightFoot"},
                                                    {"right_toe", "RightToeBase"},
                                                    {"right_collar", "RightShoulder"},
                                                    {"right_shoulder", "RightArm"},
                                                    {"right_elbow", "RightForeArm"},
                                                    {"right_wrist", "RightHand"}};
  const Quat facing(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitY()));
  const SkeletonPtr target = Changed(*clip_.skeleton(), [&](Joint& joint) {
    const double side = joint.name.starts_with("left") ? 1 : -1;
    if (joint.name.ends_with("elbow") || joint.name.ends_with("wrist")) {
      joint.offset = Vec3(0, -joint.offset.norm(), 0);
    }
    if (joint.name.ends_with("knee") || joint.name.ends_with("ankle")) {
      joint.offset = Quat(Eigen::AngleAxisd(0.35 * side, Vec3::UnitZ())) * joint.offset;
    }
    joint.offset = facing * joint.offset;
    joint.name = names.at(joint.name);
  });
  const JointRoles roles = *JointRoles::Detect(*target);
  const Clip out = *Retarget(clip_, roles_, target, roles);
  EXPECT_LT(WorstBoneAngle(clip_, roles_, out, roles), 1e-6);
  // Upright, facing the same way: the line of the hips agrees, too.
  const WorldPoses before = ForwardKinematics(clip_), after = ForwardKinematics(out);
  const auto hips = [](const WorldPoses& world, const JointRoles& of, int frame) {
    return Vec3(world.position(frame, of.joint(kLeftHip)) -
                world.position(frame, of.joint(kRightHip)));
  };
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_LT((hips(before, roles_, frame) - hips(after, roles, frame)).norm(), 1e-9);
  }
}

TEST_F(RetargetTest, JointsWithoutCounterpartStayAtRest) {
  std::vector<Joint> joints = clip_.skeleton()->joints();
  joints.push_back({"tail", 0, Vec3(0, 0, -0.2), {}});
  const SkeletonPtr cat = *Skeleton::Create(std::move(joints));
  const Clip out = *Retarget(clip_, roles_, cat, *JointRoles::Detect(*cat));
  EXPECT_LT(math::GeodesicDistance(out.rotation(30, out.num_joints() - 1), Quat::Identity()),
            1e-12);
}

TEST_F(RetargetTest, MissingRolesSayOnWhichSide) {
  const SkeletonPtr stick = *Skeleton::Create({{"stick", -1, Vec3::Zero(), {}}});
  const Status status = Retarget(clip_, roles_, stick, *JointRoles::Detect(*stick)).status();
  EXPECT_EQ(base::ErrorReason(status), "MISSING_ROLES");
  EXPECT_NE(base::Message(status).find("target skeleton"), std::string::npos);
}

}  // namespace
}  // namespace poise::motion
