#include "core/motion/editing/resample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

void ExpectSamePose(const Clip& a, int frame_a, const Clip& b, int frame_b) {
  EXPECT_EQ(a.root_position(frame_a), b.root_position(frame_b));
  for (int joint = 0; joint < a.num_joints(); ++joint) {
    EXPECT_EQ(a.rotation(frame_a, joint).coeffs(), b.rotation(frame_b, joint).coeffs());
  }
}

TEST(ResampleTest, TheSameRateGivesTheSameClipBitForBit) {
  const Clip clip = testing::SwingingClip(50);
  const Clip same = *Resample(clip, clip.frame_rate());
  ASSERT_EQ(same.num_frames(), 50);
  for (int frame = 0; frame < 50; ++frame) ExpectSamePose(clip, frame, same, frame);
}

TEST(ResampleTest, ResampleKeepsFirstAndLastPose) {
  const Clip clip = testing::SwingingClip(50);
  for (const double rate : {7.3, 30.0, 60.0, 100.0, 240.0, 1000.0}) {
    const Clip out = *Resample(clip, rate);
    EXPECT_EQ(out.frame_rate(), rate);
    ExpectSamePose(clip, 0, out, 0);
    ExpectSamePose(clip, 49, out, out.num_frames() - 1);
  }
}

TEST(ResampleTest, WholeStepsAreDecimation) {
  const Clip clip = testing::SwingingClip(121);
  const Clip out = *Resample(clip, 30);
  ASSERT_EQ(out.num_frames(), 31);
  for (int frame = 0; frame < 31; ++frame) ExpectSamePose(clip, 4 * frame, out, frame);
}

TEST(ResampleTest, NewFramesLieOnAConstantTurn) {
  const SkeletonPtr skeleton = testing::Biped();
  const int joints = skeleton->num_joints();
  const auto turn = [](double t) { return Quat(Eigen::AngleAxisd(0.9 * t, Vec3::UnitX())); };
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < 10; ++frame) {
    positions.push_back(Vec3(0, 1, 0.5 * frame));
    for (int joint = 0; joint < joints; ++joint) {
      Quat rotation = turn(frame);
      if (frame % 2) rotation.coeffs() *= -1;  // the other sign of the same rotation
      rotations.push_back(rotation);
    }
  }
  const Clip clip = *Clip::Create("turn", skeleton, 30, positions, rotations);
  const Clip out = *ResampleToFrames(clip, 23);
  EXPECT_EQ(out.frame_rate(), 30);
  for (int i = 0; i < 23; ++i) {
    const double t = 9.0 * i / 22;
    EXPECT_NEAR(out.root_position(i).z(), 0.5 * t, 1e-12);
    EXPECT_LT(math::GeodesicDistance(out.rotation(i, 3), turn(t)), 1e-12);
  }
}

TEST(ResampleTest, DurationIsTheNearestWholeFrame) {
  const Clip clip = testing::SwingingClip(121);
  const Clip slower = *ResampleToDuration(clip, 1.1);
  EXPECT_EQ(slower.num_frames(), 133);
  EXPECT_NEAR(slower.duration(), 1.1, 1e-12);
}

TEST(ResampleTest, ASinglePoseStaysOneOrIsHeld) {
  const Clip clip = testing::SwingingClip(1);
  EXPECT_EQ(Resample(clip, 30)->num_frames(), 1);
  const Clip held = *ResampleToFrames(clip, 5);
  for (int frame = 0; frame < 5; ++frame) ExpectSamePose(clip, 0, held, frame);
}

TEST(ResampleTest, BadRequestsAreRefusedWithAReason) {
  const Clip clip = testing::SwingingClip(50);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(base::ErrorReason(Resample(clip, bad).status()), "BAD_FRAME_RATE") << bad;
  }
  EXPECT_EQ(base::ErrorReason(Resample(clip, 1e8).status()), "TOO_MANY_FRAMES");
  EXPECT_EQ(base::ErrorReason(Resample(clip, 20000).status()), "BAD_FRAME_RATE");
  EXPECT_EQ(base::ErrorReason(ResampleToFrames(clip, 1).status()), "BAD_FRAME_COUNT");
  EXPECT_EQ(base::ErrorReason(ResampleToDuration(clip, -1).status()), "BAD_DURATION");
  EXPECT_EQ(base::ErrorReason(ResampleToDuration(clip, 1e12).status()), "TOO_MANY_FRAMES");
}

}  // namespace
}  // namespace poise::motion
