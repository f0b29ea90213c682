#include "core/correction/reward.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/correction/tracked_clip.h"

namespace poise::correction {
namespace {

class RewardTest : public ::testing::Test {
 protected:
  const TrackedClip clip_ = Prepare(SwayingClip(2));
  const physics::State state_ = clip_.reference.frame(180);

  Reward Score(const physics::State& simulated, const RewardConfig& config = {},
               const Vec3& force = Vec3::Zero()) const {
    return ComputeReward(*clip_.model, config, ComputeFeatures(*clip_.model, simulated),
                         ComputeFeatures(*clip_.model, state_), force, Vec3::Zero());
  }
};

TEST_F(RewardTest, IsExactlyOneForTheReferenceItselfWithoutForce) {
  for (const char* preset : {"motionaug", "rfc", "deepmimic"}) {
    const Reward reward = Score(state_, *RewardConfig::FromPreset(preset));
    EXPECT_DOUBLE_EQ(reward.total, 1) << preset;
    EXPECT_DOUBLE_EQ(reward.imitation, 1) << preset;
  }
}

TEST_F(RewardTest, TermsAreThoseOfTheFormulas) {
  physics::State off = state_;
  off.rotations[5] = off.rotations[5] * math::FromRotationVector(Vec3(0.4, 0, 0));
  off.speeds.segment<3>(physics::SpeedIndex(5)) += Vec3(0, 3, 0);
  const double weight = 0.3 / 5.3;  // of a knee, wrists fixed
  const Reward reward = Score(off, {}, Vec3(30, 0, 40));
  EXPECT_NEAR(reward.pose, std::exp(-2 * weight * 0.16), 1e-9);
  EXPECT_NEAR(reward.velocity, std::exp(-0.005 * weight * 9), 1e-9);
  EXPECT_NEAR(reward.residual, std::exp(-0.01 * 50), 1e-12);
  EXPECT_LT(reward.end_effector, 1);
  EXPECT_NEAR(reward.total, 0.9 * reward.imitation + 0.1 * reward.residual, 1e-12);
}

TEST_F(RewardTest, EndEffectorsDoNotCareWhereTheBodyStandsOrHeads) {
  physics::State moved = state_;
  moved.root_position += Vec3(2, 0, -1);
  moved.rotations[0] = math::FromRotationVector(Vec3(0, 1.2, 0)) * moved.rotations[0];
  EXPECT_NEAR(Score(moved).end_effector, 1, 1e-9);
  moved.root_position += Vec3(0, 0.1, 0);
  EXPECT_NEAR(Score(moved).end_effector, std::exp(-5 * 0.01), 1e-9);
}

TEST_F(RewardTest, EachPresetMeasuresTheSameErrorDifferently) {
  physics::State off = state_;
  off.root_position += Vec3(0.1, 0.05, 0);
  off.rotations[4] = off.rotations[4] * math::FromRotationVector(Vec3(0.3, 0, 0));
  const double motionaug = Score(off).imitation;
  const double rfc = Score(off, *RewardConfig::FromPreset("rfc")).imitation;
  const double deepmimic = Score(off, *RewardConfig::FromPreset("deepmimic")).imitation;
  EXPECT_GT(std::abs(motionaug - rfc), 0.02);
  EXPECT_GT(std::abs(motionaug - deepmimic), 0.02);
  EXPECT_GT(std::abs(rfc - deepmimic), 0.02);
  EXPECT_EQ(base::ErrorReason(RewardConfig::FromPreset("other").status()), "UNKNOWN_PRESET");
}

}  // namespace
}  // namespace poise::correction
