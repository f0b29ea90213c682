#include "core/synthesis/mirror/mirror_synthesizer.h"

#include <gtest/gtest.h>

#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/test_clips.h"

namespace poise::synthesis {
namespace {

using motion::JointRole;

TEST(MirrorSynthesizerTest, TheOutcomeOfEarlierIkIsMirroredWithTheClip) {
  const motion::Clip clip = testing::SwingingClip(60);
  const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
  const auto before = motion::ForwardKinematics(clip);
  // As if IK had put the left ankle exactly on its target.
  const Draft source{
      clip, api::IkOutcome{.end_effector = JointRole::kLeftAnkle,
                           .keyframe = 30,
                           .target = before.position(30, roles.joint(JointRole::kLeftAnkle)),
                           .reached_error_m = 0,
                           .reachable = true}};
  const MirrorSynthesizer synthesizer;
  const auto bound = *synthesizer.Bind(source, roles);
  base::Random random(1);
  const Draft mirrored = *bound->Sample(random, {});
  ASSERT_TRUE(mirrored.ik.has_value());
  EXPECT_EQ(mirrored.ik->end_effector, JointRole::kRightAnkle);
  const auto after = motion::ForwardKinematics(mirrored.clip);
  EXPECT_LT((after.position(30, roles.joint(JointRole::kRightAnkle)) - mirrored.ik->target).norm(),
            1e-9);
}

}  // namespace
}  // namespace poise::synthesis
