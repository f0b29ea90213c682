#include "core/prediction/body_mapping.h"

#include <gtest/gtest.h>

#include "core/motion/editing/cut.h"
#include "core/motion/editing/retarget.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

using enum motion::JointRole;
using motion::Clip;
using motion::JointRoles;

TEST(BodyMappingTest, SameBodyKeepsEveryRotation) {
  const Clip whole = testing::SwingingClip(30);
  const auto mapping = BodyMapping::Create(
      *motion::Cut(whole, 0, 20), *JointRoles::Detect(*whole.skeleton()), testing::Biped());
  ASSERT_TRUE(mapping.ok()) << mapping.status();
  EXPECT_EQ(mapping->on_model().rotation(3, 7).coeffs(), whole.rotation(3, 7).coeffs());
  const auto back = mapping->Back(*motion::Cut(whole, 20, 10));
  ASSERT_TRUE(back.ok());
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_LT((back->root_position(frame) - whole.root_position(20 + frame)).norm(), 1e-12);
    for (int joint = 0; joint < whole.num_joints(); ++joint) {
      EXPECT_LT(
          math::GeodesicDistance(back->rotation(frame, joint), whole.rotation(20 + frame, joint)),
          1e-7);
    }
  }
}

TEST(BodyMappingTest, BodyWithoutLegsIsRefused) {
  const auto stick = motion::Skeleton::Create({{"a", -1, motion::Vec3::Zero(), {}}});
  const Clip clip =
      *Clip::Create("stick", *stick, 60, {motion::Vec3::Zero()}, {motion::Quat::Identity()});
  const Status status =
      BodyMapping::Create(clip, *JointRoles::Detect(**stick), testing::Biped()).status();
  EXPECT_EQ(base::ErrorReason(status), "MISSING_ROLES");
}

// The true future on the model's body, brought back, is the true future of the source: every joint
// of a limb within a few millimetres, although the two bodies differ in bones, frames and size.
TEST(BodyMappingTest, FutureOfOneRealBodyComesBackThroughAnother) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  POISE_REQUIRE_DATA("cmu/test/walking/walking_1.txt");
  const Clip model_clip =
      motion::ReadClipFile(testing::DataPath("cmu/test/walking/walking_1.txt"))->clip;
  const Clip whole =
      motion::ReadClipFile(
          testing::DataPath("hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc"))
          ->clip;
  const JointRoles roles = *JointRoles::Detect(*whole.skeleton());
  const JointRoles model_roles = *JointRoles::Detect(*model_clip.skeleton());
  const Clip on_model = *motion::Retarget(whole, roles, model_clip.skeleton(), model_roles);
  const int past = 100, future = 48;

  const auto mapping =
      BodyMapping::Create(*motion::Cut(whole, 0, past), roles, model_clip.skeleton());
  ASSERT_TRUE(mapping.ok()) << mapping.status();
  const auto back = mapping->Back(*motion::Cut(on_model, past, future));
  ASSERT_TRUE(back.ok()) << back.status();

  const motion::WorldPoses got = motion::ForwardKinematics(*back);
  const motion::WorldPoses truth = motion::ForwardKinematics(*motion::Cut(whole, past, future));
  double largest = 0;
  for (int frame = 0; frame < future; ++frame) {
    for (const auto role : {kLeftAnkle, kRightAnkle, kLeftWrist, kRightWrist, kNeck}) {
      const int joint = roles.joint(role);
      largest =
          std::max(largest, (got.position(frame, joint) - truth.position(frame, joint)).norm());
    }
  }
  std::printf("largest distance of hands, feet and neck: %.1f mm\n", 1000 * largest);
  EXPECT_LT(largest, 0.03);
}

}  // namespace
}  // namespace poise::prediction
