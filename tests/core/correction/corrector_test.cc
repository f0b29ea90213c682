#include "core/correction/corrector.h"

#include <gtest/gtest.h>

#include "core/motion/io/clip_file.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "tests/core/correction/tracked_clip.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::correction {
namespace {

motion::JointRoles RolesOf(const motion::Clip& clip) {
  return *motion::JointRoles::Detect(*clip.skeleton());
}

TEST(CorrectorTest, ReturnsTheMotionOnItsOwnSkeletonWithItsMeasures) {
  const motion::Clip clip = SwayingClip(2);
  const Corrector corrector = std::move(Corrector::Create(clip, RolesOf(clip))).value();
  const Correction correction = *corrector.Correct(clip);
  EXPECT_TRUE(correction.score.completed);
  EXPECT_TRUE(correction.clip.skeleton()->SameAs(*clip.skeleton()));
  EXPECT_EQ(correction.clip.num_frames(), clip.num_frames());
  EXPECT_LT(correction.after.penetration_max_m, 0.006);
  EXPECT_LT(correction.after.float_mean_m, 0.005);
  // The arm that sways does so after, too.
  const int hand = RolesOf(clip).joint(motion::JointRole::kLeftWrist);
  const double sway = motion::ForwardKinematics(clip).position(240, hand).y() -
                      motion::ForwardKinematics(clip).position(0, hand).y();
  const double swayed = motion::ForwardKinematics(correction.clip).position(240, hand).y() -
                        motion::ForwardKinematics(correction.clip).position(0, hand).y();
  EXPECT_NEAR(swayed, sway, 0.05);
}

TEST(CorrectorTest, FeetBelowTheFloorComeToStandOnIt) {
  motion::Clip sunk = SwayingClip(2);
  for (int frame = 0; frame < sunk.num_frames(); ++frame) {
    sunk.root_position(frame).y() -= 0.05 * frame / sunk.num_frames();
  }
  CorrectionConfig config;
  config.reference.floor = "none";
  for (int frame = 0; frame < sunk.num_frames(); ++frame) {
    sunk.root_position(frame).y() -= 0.95 - 0.9;
  }
  const motion::Clip source = SwayingClip(1);
  const Corrector corrector = std::move(Corrector::Create(source, RolesOf(source), config)).value();
  const Correction correction = *corrector.Correct(sunk);
  EXPECT_GT(correction.before.penetration_mean_m, 0.02);
  EXPECT_LT(correction.after.penetration_mean_m, 0.5 * correction.before.penetration_mean_m);
}

TEST(CorrectorTest, TheEffortDecidesHowOftenItTries) {
  const motion::Clip clip = SwayingClip(1);
  for (const auto& [effort, rollouts] : {std::pair("instant", 1u), std::pair("fast", 5u)}) {
    CorrectionConfig config;
    config.effort = effort;
    config.learning.rollouts = 5;
    const Corrector corrector = std::move(Corrector::Create(clip, RolesOf(clip), config)).value();
    EXPECT_EQ(corrector.Correct(clip)->rollouts.size(), rollouts);
  }
}

TEST(CorrectorTest, RefusesAnotherSkeletonAndBadValues) {
  const motion::Clip clip = SwayingClip(1);
  CorrectionConfig config;
  config.tracking.residual_factor = 3;
  const auto bad = Corrector::Create(clip, RolesOf(clip), config);
  EXPECT_EQ(base::ErrorReason(bad.status()), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(base::ErrorField(bad.status()), "tracking.residual_factor");
  const Corrector corrector = std::move(Corrector::Create(clip, RolesOf(clip))).value();
  const motion::Clip reduced = Prepare(clip).reference.clip();
  EXPECT_EQ(base::ErrorReason(corrector.Correct(reduced).status()), "WRONG_SKELETON");
  EXPECT_EQ(base::ErrorReason(CorrectionConfig::FromPreset("best").status()), "UNKNOWN_PRESET");
}

class RealClipTest : public ::testing::TestWithParam<const char*> {};

TEST_P(RealClipTest, IsCompletedWithoutPenetration) {
  POISE_REQUIRE_DATA(GetParam());
  const motion::Clip clip = motion::ReadClipFile(testing::DataPath(GetParam()))->clip;
  const Corrector corrector = std::move(Corrector::Create(clip, RolesOf(clip))).value();
  const Correction correction = *corrector.Correct(clip);
  EXPECT_TRUE(correction.score.completed);
  EXPECT_LT(correction.after.penetration_mean_m, 0.0005);
  EXPECT_LT(correction.after.penetration_max_m, 0.006);
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealClipTest,
    ::testing::Values("hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc",
                      "hdm05/grabHighR/HDM_bd_grabHighR_001_120.amc",
                      "hdm05/hopBothLegs1hops/HDM_bk_hopBothLegs1hops_013_120.amc"));

}  // namespace
}  // namespace poise::correction
