#include "tests/support/broken_clips.h"

#include <gtest/gtest.h>

#include "core/correction/corrector.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/io/clip_file.h"
#include "core/physics/floor_alignment.h"
#include "tests/support/data_files.h"

namespace poise::correction {
namespace {

using testing::Fault;

constexpr const char* kFiles[] = {
    "hdm05/kickLFront1Reps/HDM_bd_kickLFront1Reps_001_120.amc",
    "hdm05/jogLeftCircle4StepsRstart/HDM_bd_jogLeftCircle4StepsRstart_001_120.amc",
    "hdm05/sneak2StepsLStart/HDM_mm_sneak2StepsLStart_011_120.amc",
    "hdm05/grabHighR/HDM_dg_grabHighR_011_120.amc",
    "hdm05/kickLFront1Reps/HDM_tr_kickLFront1Reps_025_120.amc",
};

// The clip on the floor y = 0 by the character's own feet, so that a fault is a fault against it.
motion::Clip OnFloor(motion::Clip clip, const motion::JointRoles& roles) {
  const motion::Clip reduced =
      *motion::ReduceToRoles(clip, roles, motion::ReductionMode::kComposed);
  const auto model =
      *physics::HumanoidModel::Create(reduced, *motion::ReducedRoles(*reduced.skeleton()));
  const double floor = physics::FloorHeight(reduced, model->shapes(), physics::FloorRule::kMedian);
  for (int f = 0; f < clip.num_frames(); ++f) clip.root_position(f).y() -= floor;
  return clip;
}

// Sums over the inputs of one kind.
struct Measures {
  int completed = 0;
  double skating = 0, penetration = 0, floating = 0, overlap = 0;

  void Add(const motion::Plausibility& measured) {
    skating += measured.foot_skate_mps;
    penetration += measured.penetration_mean_m;
    floating += measured.float_mean_m;
    overlap += measured.self_penetration_max_m;
  }
};

class BrokenClipsTest : public ::testing::TestWithParam<Fault> {};

TEST_P(BrokenClipsTest, ComeBackAtMostHalfAsBroken) {
  Measures before, after;
  for (const char* name : kFiles) {
    POISE_REQUIRE_DATA(name);
    const motion::Clip clip = motion::ReadClipFile(testing::DataPath(name))->clip;
    const motion::JointRoles roles = *motion::JointRoles::Detect(*clip.skeleton());
    const motion::Clip broken = testing::Break(OnFloor(clip, roles), roles, GetParam());
    CorrectionConfig config;
    config.effort = "instant";
    config.reference.floor = "none";
    const Corrector corrector = std::move(Corrector::Create(broken, roles, config)).value();
    const Correction correction = *corrector.Correct(broken);
    after.completed += correction.score.completed;
    before.Add(correction.before);
    after.Add(correction.after);
  }
  EXPECT_EQ(after.completed, 5);
  EXPECT_LT(after.penetration, 0.5 * before.penetration);
  switch (GetParam()) {
    case Fault::kCrossedLegs:
      EXPECT_GT(before.overlap / 5, 0.05);
      EXPECT_LT(after.overlap, 0.5 * before.overlap);
      EXPECT_LT(after.skating, 0.5 * before.skating);
      break;
    case Fault::kSunk:
      EXPECT_GT(before.penetration / 5, 0.02);
      break;
    case Fault::kSlidingFeet:
      EXPECT_GT(before.skating / 5, 0.3);
      EXPECT_LT(after.skating, 0.5 * before.skating);
      break;
    case Fault::kFloating:
      EXPECT_GT(before.floating / 5, 0.02);
      EXPECT_LT(after.floating, 0.5 * before.floating);
      break;
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, BrokenClipsTest, ::testing::ValuesIn(testing::kFaults),
                         [](const auto& info) {
                           return std::string(testing::FaultName(info.param));
                         });

}  // namespace
}  // namespace poise::correction
