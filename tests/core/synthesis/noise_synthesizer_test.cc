#include "core/synthesis/noise/noise_synthesizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/test_clips.h"

namespace poise::synthesis {
namespace {

using motion::Quat;
using motion::Vec3;

// A body that stands still except for one knee, which swings about x by 0.5 sin, and a root that
// moves along z by 0.2 sin.
motion::Clip SwingingKnee(int frames, int knee) {
  const auto skeleton = testing::Biped();
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = 0; frame < frames; ++frame) {
    const double wave = std::sin(2 * std::numbers::pi * frame / 100);
    positions.push_back(Vec3(0, 1, 0.2 * wave));
    for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
      rotations.push_back(Quat(Eigen::AngleAxisd(joint == knee ? 0.5 * wave : 0, Vec3::UnitX())));
    }
  }
  return *motion::Clip::Create("knee", skeleton, 120, std::move(positions), std::move(rotations));
}

TEST(NoiseSynthesizerTest, NoiseIsAFractionOfEachDimensionsDeviationAndTheRestStays) {
  const int frames = 4000;
  const auto skeleton = testing::Biped();
  const int knee = *skeleton->Find("left_knee");
  const Draft source{SwingingKnee(frames, knee), std::nullopt};
  const motion::JointRoles roles = *motion::JointRoles::Detect(*skeleton);
  const NoiseSynthesizer synthesizer{NoiseConfig{.fraction = 0.1}};
  const auto bound = *synthesizer.Bind(source, roles);
  base::Random random(1);
  const Draft variant = *bound->Sample(random, {});

  double knee_square = 0, root_square = 0, mean = 0;
  for (int frame = 0; frame < frames; ++frame) {
    for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
      if (joint == knee) continue;
      ASSERT_EQ(variant.clip.rotation(frame, joint).coeffs(),
                source.clip.rotation(frame, joint).coeffs());
    }
    const Vec3 moved = math::ToRotationVector(source.clip.rotation(frame, knee).conjugate() *
                                              variant.clip.rotation(frame, knee));
    EXPECT_NEAR(moved.y(), 0, 1e-9);
    knee_square += moved.x() * moved.x();
    mean += moved.x() / frames;
    const Vec3 shift = variant.clip.root_position(frame) - source.clip.root_position(frame);
    EXPECT_EQ(shift.x(), 0);
    root_square += shift.z() * shift.z();
  }
  // The deviation of a sine is its amplitude over sqrt 2; 4000 draws tell it to about 1 %.
  EXPECT_NEAR(std::sqrt(knee_square / frames), 0.1 * 0.5 / std::numbers::sqrt2, 0.0015);
  EXPECT_NEAR(std::sqrt(root_square / frames), 0.1 * 0.2 / std::numbers::sqrt2, 0.0006);
  EXPECT_NEAR(mean, 0, 0.003);
}

}  // namespace
}  // namespace poise::synthesis
