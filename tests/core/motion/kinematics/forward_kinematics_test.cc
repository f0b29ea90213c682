#include "core/motion/kinematics/forward_kinematics.h"

#include <gtest/gtest.h>

#include "core/base/isa.h"
#include "core/motion/kinematics/forward_kinematics_kernel.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

// World transform of one joint, by multiplying 4 x 4 matrices down its chain.
Eigen::Affine3d NaiveTransform(const Clip& clip, int frame, int joint) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  for (int j = joint; j >= 0; j = clip.skeleton()->parent(j)) {
    const Vec3 offset = j == 0 ? clip.root_position(frame) : clip.skeleton()->joint(j).offset;
    Eigen::Affine3d local = Eigen::Affine3d::Identity();
    local.linear() = clip.rotation(frame, j).toRotationMatrix();
    local.translation() = offset;
    transform = local * transform;
  }
  return transform;
}

TEST(ForwardKinematicsTest, AgreesWithProductsOfMatrices) {
  const Clip clip = testing::SwingingClip(25, 30, 2.5);
  const WorldPoses world = ForwardKinematics(clip);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      const Eigen::Affine3d expected = NaiveTransform(clip, frame, joint);
      EXPECT_LT((world.position(frame, joint) - expected.translation()).norm(), 1e-12);
      EXPECT_LT((world.rotation(frame, joint).toRotationMatrix() - expected.linear()).norm(),
                1e-12);
      const Vec3 point(0.1, -0.2, 0.3);
      EXPECT_LT((world.Point(frame, joint, point) - expected * point).norm(), 1e-12);
    }
  }
}

TEST(ForwardKinematicsTest, APartOfTheClipGivesTheSameFramesInReusedMemory) {
  const Clip clip = testing::SwingingClip(25);
  const WorldPoses all = ForwardKinematics(clip);
  WorldPoses some;
  for (const auto& [first, count] : {std::pair(0, 25), std::pair(7, 3), std::pair(24, 1)}) {
    ForwardKinematics(clip, first, count, some);
    ASSERT_EQ(some.num_frames, count);
    for (int frame = 0; frame < count; ++frame) {
      EXPECT_EQ(some.position(frame, 12), all.position(first + frame, 12));
      EXPECT_EQ(some.rotation(frame, 12).coeffs(), all.rotation(first + frame, 12).coeffs());
    }
  }
  ForwardKinematics(clip, 0, 0, some);
  EXPECT_TRUE(some.positions.empty());
}

TEST(ForwardKinematicsTest, TheRootsOwnOffsetDoesNotAdd) {
  const SkeletonPtr skeleton = *Skeleton::Create({{"root", -1, Vec3(9, 9, 9), {}}});
  const Clip clip = *Clip::Create("one", skeleton, 30, {Vec3(1, 2, 3)}, {Quat::Identity()});
  EXPECT_EQ(ForwardKinematics(clip).position(0, 0), Vec3(1, 2, 3));
}

TEST(ForwardKinematicsTest, EveryInstructionSetOfThisCpuAgreesWithTheLeastOne) {
  const Clip clip = testing::SwingingClip(40, 30, 2.0);
  const int joints = clip.num_joints();
  std::vector<int> parents;
  std::vector<Vec3> offsets;
  for (const Joint& joint : clip.skeleton()->joints()) {
    parents.push_back(joint.parent);
    offsets.push_back(joint.offset);
  }
  const auto run = [&](auto* kernel) {
    std::vector<double> out(7 * static_cast<size_t>(clip.num_frames()) * joints);
    kernel({.num_frames = clip.num_frames(),
            .num_joints = joints,
            .parents = parents.data(),
            .offsets = offsets.data()->data(),
            .root_positions = clip.root_positions().data()->data(),
            .local = clip.rotations().data()->coeffs().data(),
            .positions = out.data(),
            .rotations = out.data() + 3 * static_cast<size_t>(clip.num_frames()) * joints});
    return out;
  };
  const std::vector<double> least = run(isa_v2::ForwardKinematicsKernel);
  const auto expect_same = [&](const std::vector<double>& other) {
    for (size_t i = 0; i < least.size(); ++i) ASSERT_NEAR(other[i], least[i], 1e-12) << i;
  };
  if (base::BestIsa() >= base::Isa::kV3) expect_same(run(isa_v3::ForwardKinematicsKernel));
  if (base::BestIsa() >= base::Isa::kV4) expect_same(run(isa_v4::ForwardKinematicsKernel));
}

}  // namespace
}  // namespace poise::motion
