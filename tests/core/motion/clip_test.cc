#include "core/motion/clip.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

class ClipTest : public ::testing::Test {
 protected:
  StatusOr<Clip> Create() { return Clip::Create("kick", skeleton_, rate_, positions_, rotations_); }

  SkeletonPtr skeleton_ = testing::Biped();
  double rate_ = 30;
  std::vector<Vec3> positions_ = std::vector<Vec3>(4, Vec3(0, 1, 0));
  std::vector<Quat> rotations_ = std::vector<Quat>(4 * 21, Quat::Identity());
};

TEST_F(ClipTest, HoldsItsNumbersFrameByFrame) {
  rotations_[2 * 21 + 5] = Quat(0, 1, 0, 0);
  const Clip clip = *Create();
  EXPECT_EQ(clip.num_frames(), 4);
  EXPECT_EQ(clip.num_joints(), 21);
  EXPECT_DOUBLE_EQ(clip.duration(), 0.1);
  EXPECT_EQ(clip.rotation(2, 5).coeffs(), Quat(0, 1, 0, 0).coeffs());
  EXPECT_EQ(clip.pose(2)[5].coeffs(), clip.rotation(2, 5).coeffs());
}

TEST_F(ClipTest, NearlyUnitQuaternionsAreNormalisedAndUnitOnesKept) {
  rotations_[7] = Quat(0.6, 0.8, 0, 0);
  rotations_[8].coeffs() *= 1.005;
  const Clip clip = *Create();
  EXPECT_EQ(clip.rotation(0, 7).coeffs(), Quat(0.6, 0.8, 0, 0).coeffs());
  EXPECT_NEAR(clip.rotation(0, 8).norm(), 1, 1e-15);
}

TEST_F(ClipTest, WrongShapesAndRatesAreRefused) {
  for (const double bad : {0.0, -30.0, 1e5, std::numeric_limits<double>::quiet_NaN()}) {
    rate_ = bad;
    EXPECT_EQ(base::ErrorReason(Create().status()), "BAD_FRAME_RATE") << bad;
  }
  rate_ = 30;
  rotations_.pop_back();
  EXPECT_EQ(base::ErrorReason(Create().status()), "WRONG_SHAPE");
  positions_.clear();
  EXPECT_EQ(base::ErrorReason(Create().status()), "NO_FRAMES");
}

TEST_F(ClipTest, BadNumbersAreNamedByFrameAndJoint) {
  rotations_[2 * 21 + 6].coeffs() *= 2;
  Status status = Create().status();
  EXPECT_EQ(base::ErrorReason(status), "NOT_A_ROTATION");
  EXPECT_NE(base::Message(status).find("frame 2, joint 'right_knee'"), std::string::npos) << status;
  rotations_[2 * 21 + 6].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(base::ErrorReason(Create().status()), "NOT_FINITE");
  rotations_[2 * 21 + 6] = Quat::Identity();
  positions_[3].z() = std::numeric_limits<double>::quiet_NaN();
  status = Create().status();
  EXPECT_EQ(base::ErrorReason(status), "NOT_FINITE");
  EXPECT_NE(base::Message(status).find("frame 3"), std::string::npos) << status;
}

}  // namespace
}  // namespace poise::motion
