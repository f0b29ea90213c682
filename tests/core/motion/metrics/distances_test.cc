// Distances between motions, by numbers computed by hand.
#include <gmock/gmock.h>

#include <array>

#include "core/motion/metrics/ade_fde.h"
#include "core/motion/metrics/bone_length.h"
#include "core/motion/metrics/foot_skate.h"
#include "core/motion/metrics/footsteps.h"
#include "core/motion/metrics/mpjpe.h"

namespace poise::motion {
namespace {

// Two frames of two joints.
const std::vector<Vec3> kTruth = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
const std::vector<Vec3> kFound = {{0, 0, 0}, {0, 1, 3}, {1, 0, 4}, {1, 1, 4}};
const PositionsView kTrue{2, kTruth};
const PositionsView kPredicted{2, kFound};
constexpr std::array kFoot = {0};

TEST(DistancesTest, MpjpeIsTheMeanDistance) {
  EXPECT_DOUBLE_EQ(Mpjpe(kPredicted, kTrue), (0 + 3 + 4 + 4) / 4.0);
  EXPECT_DOUBLE_EQ(RootAlignedMpjpe(kPredicted, kTrue, 0), 3 / 4.0);
}

TEST(DistancesTest, PathErrorKnowsTheMeanAndTheLastFrame) {
  const DisplacementError error = PathError(kPredicted, kTrue, 0);
  EXPECT_DOUBLE_EQ(error.average, 2);
  EXPECT_DOUBLE_EQ(error.final, 4);
}

TEST(DistancesTest, BoneLengthErrorComparesLengthsOnly) {
  constexpr std::array kParents = {-1, 0};
  EXPECT_DOUBLE_EQ(BoneLengthError(kPredicted, kTrue, kParents), (std::sqrt(10.0) - 1) / 2);
}

TEST(DistancesTest, FootSkateWeighsSpeedByHeightAndLeavesHighFeetOut) {
  // A joint at height 0, then half the threshold, then above it; steps of 1 cm and a rise.
  const std::vector<Vec3> path = {{0, 0, 0}, {0.01, 0.025, 0}, {0.02, 0.2, 0}};
  const PositionsView motion{1, path};
  const FootJoints feet{kFoot, 1};
  EXPECT_NEAR(FootSkateError(motion, feet, 0.05, 60), 0.6 * (2 - std::sqrt(2.0)), 1e-12);
  EXPECT_DOUBLE_EQ(ContactShare(motion, feet, 0.05), 2 / 3.0);
  EXPECT_DOUBLE_EQ(FootSkateError(motion.From(2), feet, 0.05, 60), 0);
}

TEST(DistancesTest, AFootStepsWhenItGoesFastAndFarEnough) {
  // Stands 20 frames, goes 2 cm a frame for 15, stands; then trembles by 2 cm.
  std::vector<Vec3> path;
  for (int frame = 0; frame < 80; ++frame) {
    const double along = 0.02 * std::clamp(frame - 20, 0, 15);
    path.push_back({along + (frame == 70 ? 0.02 : 0), 0, 0});
  }
  const FootJoints feet{kFoot, 1};
  const auto steps = FindFootsteps({1, path}, feet, 60);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_NEAR(steps[0].first, 20, 2);
  EXPECT_NEAR(steps[0].last, 35, 2);
}

TEST(DistancesTest, AStepIsRecalledByOneOfTheSameFootWithinTheTolerance) {
  const std::vector<Footstep> truth = {{0, 10, 20}, {1, 30, 40}};
  EXPECT_EQ(CountRecalled({{0, 27, 35}}, truth, 8), 1);
  EXPECT_EQ(CountRecalled({{0, 29, 35}}, truth, 8), 0);
  EXPECT_EQ(CountRecalled({{0, 0, 60}, {1, 0, 60}}, truth, 8), 2);
}

}  // namespace
}  // namespace poise::motion
