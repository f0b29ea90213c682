#include "core/motion/kinematics/sole_estimate.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

using enum JointRole;

// The biped standing, written with its ankle frames turned: offsets change, the motion does not.
TEST(SoleEstimateTest, FindsTheSoleInAnyAnkleFrame) {
  std::vector<Joint> joints = testing::Biped()->joints();
  const int ankle = *testing::Biped()->Find("left_ankle"),
            toe = *testing::Biped()->Find("left_toe");
  const Quat turn = math::FromEuler(Vec3(1.1, -0.4, 2.0), math::kXYZ);
  joints[toe].offset = turn.conjugate() * joints[toe].offset;
  const SkeletonPtr skeleton = *Skeleton::Create(std::move(joints));
  std::vector<Quat> pose(skeleton->num_joints(), Quat::Identity());
  pose[ankle] = turn;
  const Clip clip = *Clip::Create("stand", skeleton, 30, {Vec3(0, 1, 0)}, pose);
  const Soles soles =
      EstimateSoles(*skeleton, *JointRoles::Detect(*skeleton), ForwardKinematics(clip));
  EXPECT_LT((turn * soles.left.up - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((turn * soles.left.forward - Vec3::UnitZ()).norm(), 1e-9);
  EXPECT_LT((soles.right.up - Vec3::UnitY()).norm(), 1e-9);
}

TEST(SoleEstimateTest, AFootThatOnlyPointsDownFallsBackOnTheRestPose) {
  const SkeletonPtr skeleton = testing::Biped();
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  std::vector<Quat> pose(skeleton->num_joints(), Quat::Identity());
  pose[roles.joint(kLeftAnkle)] = math::SwingBetween(Vec3(0, -0.06, 0.14), Vec3(0, -1, 0));
  const Clip clip = *Clip::Create("tiptoe", skeleton, 30, {Vec3(0, 1, 0)}, pose);
  const Soles soles = EstimateSoles(*skeleton, roles, ForwardKinematics(clip));
  EXPECT_LT((soles.left.up - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((soles.left.forward - Vec3::UnitZ()).norm(), 1e-9);
}

}  // namespace
}  // namespace poise::motion
