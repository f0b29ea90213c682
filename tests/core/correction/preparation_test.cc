#include "core/correction/preparation/preparation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/correction/preparation/foot_track.h"
#include "core/motion/editing/resample.h"
#include "core/motion/metrics/plausibility.h"
#include "tests/core/correction/tracked_clip.h"
#include "tests/support/data_files.h"

namespace poise::correction {
namespace {

constexpr int kRightHip = 4, kLeftHip = 10;

class PreparationTest : public ::testing::Test {
 protected:
  PreparationTest() : tracked_(Prepare(SwayingClip(3))), clip_(tracked_.reference.clip()) {}

  motion::Clip Prepared() const { return PrepareMotion(clip_, *tracked_.model, {}); }
  motion::Plausibility Measure(const motion::Clip& clip) const {
    return *motion::AssessPlausibility(clip, tracked_.model->shapes(), 0);
  }

  TrackedClip tracked_;
  motion::Clip clip_;  // stands still for three seconds, 361 frames
};

TEST_F(PreparationTest, ASoundMotionStays) {
  const motion::Clip prepared = Prepared();
  for (int f = 0; f < clip_.num_frames(); ++f) {
    EXPECT_LT((prepared.root_position(f) - clip_.root_position(f)).norm(), 2e-3);
    for (int i = 0; i < clip_.num_joints(); ++i) {
      EXPECT_LT(math::GeodesicDistance(prepared.rotation(f, i), clip_.rotation(f, i)), 0.02);
    }
  }
}

TEST_F(PreparationTest, ABodyThatFloatsOrSinksForAWhileComesToStand) {
  for (const double off : {0.05, -0.05}) {
    const motion::Clip sound = clip_;
    for (int f = 120; f < 300; ++f) {
      clip_.root_position(f).y() += off * std::pow(std::sin(M_PI * (f - 120) / 180.0), 2);
    }
    const motion::Plausibility before = Measure(clip_), after = Measure(Prepared());
    EXPECT_GT(before.float_mean_m + before.penetration_mean_m, 0.01);
    EXPECT_LT(after.float_mean_m + after.penetration_mean_m, 0.001);
    clip_ = sound;
  }
}

TEST_F(PreparationTest, AJumpStaysAJump) {
  for (int f = 120; f < 180; ++f) {  // half a second in the air
    const double t = (f - 120) / 120.0;
    clip_.root_position(f).y() += 4.9 * t * (0.5 - t);
  }
  const motion::Clip prepared = Prepared();
  EXPECT_GT(prepared.root_position(150).y(), clip_.root_position(150).y() - 0.02);
}

TEST_F(PreparationTest, FeetThatGlideWithTheBodyStand) {
  for (int f = 0; f < clip_.num_frames(); ++f) {
    clip_.root_position(f).x() += 0.1 * std::sin(0.02 * f);
  }
  const motion::Clip prepared = Prepared();
  EXPECT_GT(Measure(clip_).foot_skate_mps, 0.1);
  EXPECT_LT(Measure(prepared).foot_skate_mps, 0.01);
  // The body follows: the legs keep their shape.
  EXPECT_LT(math::GeodesicDistance(prepared.rotation(180, kLeftHip), clip_.rotation(180, kLeftHip)),
            0.1);
}

TEST_F(PreparationTest, OneFootThatSlidesStandsAndTheBodyStays) {
  for (int f = 0; f < clip_.num_frames(); ++f) {
    const double angle = 0.05 * std::sin(0.02 * f);
    clip_.rotation(f, kLeftHip) =
        math::FromRotationVector(Vec3(0, 0, angle)) * clip_.rotation(f, kLeftHip);
  }
  const motion::Clip prepared = Prepared();
  EXPECT_LT(Measure(prepared).foot_skate_mps, 0.3 * Measure(clip_).foot_skate_mps);
  for (int f = 0; f < clip_.num_frames(); ++f) {
    EXPECT_LT((prepared.root_position(f) - clip_.root_position(f)).norm(), 0.02);
  }
}

TEST_F(PreparationTest, LegsThatCrossComeApart) {
  for (int f = 0; f < clip_.num_frames(); ++f) {
    const double angle = 0.2 * std::pow(std::sin(M_PI * f / 360.0), 2);
    for (const auto& [hip, sign] : {std::pair(kRightHip, 1), std::pair(kLeftHip, -1)}) {
      clip_.rotation(f, hip) =
          math::FromRotationVector(Vec3(0, 0, sign * angle)) * clip_.rotation(f, hip);
    }
  }
  EXPECT_GT(Measure(clip_).self_penetration_max_m, 0.03);
  EXPECT_LT(Measure(Prepared()).self_penetration_max_m,
            0.5 * Measure(clip_).self_penetration_max_m);
}

TEST_F(PreparationTest, SwitchedOffItChangesNothing) {
  clip_.root_position(50).y() += 0.03;
  const motion::Clip prepared = PrepareMotion(clip_, *tracked_.model, {.enabled = false});
  EXPECT_EQ(prepared.root_position(50), clip_.root_position(50));
  EXPECT_EQ(prepared.rotation(50, 5).coeffs(), clip_.rotation(50, 5).coeffs());
}

TEST(RealStepsTest, ContactsAreTheSameAt30And120Hertz) {
  const char* name = "hdm05/sneak2StepsLStart/HDM_bd_sneak2StepsLStart_001_120.amc";
  POISE_REQUIRE_DATA(name);
  const TrackedClip tracked = ReadAndPrepare(testing::DataPath(name));
  const auto standing = [&](const motion::Clip& clip) {
    std::array<FootTrack, 2> feet = TrackFeet(clip, *tracked.model);
    for (FootTrack& foot : feet) {
      FindContacts(FindFlight(clip, *tracked.model), clip.frame_rate(), {}, foot);
    }
    return feet;
  };
  const motion::Clip& fast = tracked.reference.source_clip();
  const motion::Clip slow = *motion::Resample(fast, 30);
  const auto at_120 = standing(fast), at_30 = standing(slow);
  int same = 0;
  for (int f = 0; f < slow.num_frames(); ++f) {
    for (int side = 0; side < 2; ++side) {
      same +=
          at_30[side].standing[f] == at_120[side].standing[std::min(4 * f, fast.num_frames() - 1)];
    }
  }
  EXPECT_GT(same, 0.93 * 2 * slow.num_frames());
}

TEST(RealStepsTest, AFootThatSwingsLowIsLiftedMoreAndAStandingOneIsNot) {
  const char* name = "hdm05/jogLeftCircle4StepsRstart/HDM_bd_jogLeftCircle4StepsRstart_001_120.amc";
  POISE_REQUIRE_DATA(name);
  ReferenceConfig without;
  without.preparation.clearance_m = 0;
  const TrackedClip plain = ReadAndPrepare(testing::DataPath(name), without);
  const TrackedClip lifted = ReadAndPrepare(testing::DataPath(name));
  const double clearance = ReferenceConfig().preparation.clearance_m;
  const auto before = TrackFeet(plain.reference.clip(), *plain.model);
  const auto after = TrackFeet(lifted.reference.clip(), *lifted.model);
  int swings = 0;
  for (int f = 0; f < plain.reference.num_frames(); ++f) {
    const std::array<double, 2> loads = lifted.reference.FootLoads(f / 120.0);
    for (int side = 0; side < 2; ++side) {
      if (loads[side] == 1) {
        EXPECT_LT(after[side].heights[f], 0.005) << f;
      }
      if (before[side].speeds[f] < 2 || before[side].heights[f] > 0.04) continue;
      ++swings;
      EXPECT_NEAR(after[side].heights[f] - before[side].heights[f], clearance, 0.5 * clearance);
    }
  }
  EXPECT_GE(swings, 3);
}

TEST(RealStepsTest, FeetStandStillerAndNothingJumps) {
  const char* name = "hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc";
  POISE_REQUIRE_DATA(name);
  const TrackedClip tracked = ReadAndPrepare(testing::DataPath(name));
  const auto measure = [&](const motion::Clip& clip) {
    return *motion::AssessPlausibility(clip, tracked.model->shapes(), 0);
  };
  const motion::Plausibility before = measure(tracked.reference.source_clip());
  const motion::Plausibility after = measure(tracked.reference.clip());
  EXPECT_LT(after.foot_skate_mps, before.foot_skate_mps);
  EXPECT_LT(after.penetration_max_m, 1e-3);
  EXPECT_LT(after.acceleration_rms_mps2, 1.1 * before.acceleration_rms_mps2);
}

}  // namespace
}  // namespace poise::correction
