#include "core/motion/editing/align.h"

#include <gtest/gtest.h>

#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

TEST(AlignTest, ToesStandAtTheOriginAndTheBodyFacesZ) {
  Clip clip = testing::SwingingClip(30, 120, 0.5);
  const Quat turn(Eigen::AngleAxisd(2.1, Vec3::UnitY()));
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    clip.root_position(frame) = turn * clip.root_position(frame) + Vec3(3, 0.4, -7);
    clip.rotation(frame, 0) = turn * clip.rotation(frame, 0);
  }
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  for (const int frame : {1, 12}) {
    const Clip aligned = *Align(clip, roles, frame);
    const WorldPoses world = ForwardKinematics(aligned);
    const auto at = [&](const char* joint) {
      return world.position(frame, *clip.skeleton()->Find(joint));
    };
    const Vec3 middle = (at("left_toe") + at("right_toe")) / 2;
    EXPECT_NEAR(middle.x(), 0, 1e-12);
    EXPECT_NEAR(middle.z(), 0, 1e-12);
    EXPECT_NEAR(std::min(at("left_toe").y(), at("right_toe").y()), 0, 1e-12);
    const Vec3 across = at("right_shoulder") - at("left_shoulder");
    EXPECT_LT(across.x(), -0.1);
    EXPECT_NEAR(across.z(), 0, 1e-12);
  }
}

TEST(AlignTest, LocalMotionStaysAndAlignedClipsStayPut) {
  const Clip clip = testing::SwingingClip(30);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  const Clip once = *Align(clip, roles), twice = *Align(once, roles);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    EXPECT_LT((once.root_position(frame) - twice.root_position(frame)).norm(), 1e-12);
    for (int joint = 1; joint < clip.num_joints(); ++joint) {
      EXPECT_EQ(once.rotation(frame, joint).coeffs(), clip.rotation(frame, joint).coeffs());
    }
  }
}

TEST(AlignTest, BodiesThatFaceNowhereAndBadFramesAreRefused) {
  const Clip clip = testing::SwingingClip(5, 120, 0);
  const JointRoles roles = *JointRoles::Detect(*clip.skeleton());
  EXPECT_EQ(base::ErrorReason(Align(clip, roles, -1).status()), "BAD_FRAME");
  Clip lying = clip;
  for (int frame = 0; frame < 5; ++frame) {
    lying.rotation(frame, 0) = math::SwingBetween(Vec3::UnitX(), Vec3::UnitY());
  }
  EXPECT_EQ(base::ErrorReason(Align(lying, roles).status()), "NO_HEADING");
  EXPECT_TRUE(Align(clip, roles, 100).ok());
}

}  // namespace
}  // namespace poise::motion
