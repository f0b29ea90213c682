#include <gtest/gtest.h>

#include "core/prediction/predictor_registry.h"
#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

using motion::Clip;
using motion::Quat;
using motion::Vec3;

// Every joint turns at a constant rate about its own axis, the root goes straight.
Clip SteadyClip(int first, int frames) {
  const motion::SkeletonPtr skeleton = testing::Biped();
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  for (int frame = first; frame < first + frames; ++frame) {
    positions.emplace_back(0.01 * frame, 1, -0.02 * frame);
    for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
      const Vec3 axis(1, 0.1 * joint, -0.5);
      rotations.push_back(math::FromRotationVector(0.03 * frame * axis));
    }
  }
  return *Clip::Create("steady", skeleton, 60, positions, rotations);
}

double LargestDifference(const Clip& a, const Clip& b) {
  double largest = 0;
  for (int frame = 0; frame < a.num_frames(); ++frame) {
    largest = std::max(largest, (a.root_position(frame) - b.root_position(frame)).norm());
    for (int joint = 0; joint < a.num_joints(); ++joint) {
      largest = std::max(
          largest, math::GeodesicDistance(a.rotation(frame, joint), b.rotation(frame, joint)));
    }
  }
  return largest;
}

TEST(ZeroVelocityTest, HoldsTheLastPoseBitForBit) {
  const Clip past = testing::SwingingClip(7);
  const auto futures = FindBuiltInPredictor("zero-velocity")->Predict({{{past}}}, 3, {});
  ASSERT_TRUE(futures.ok()) << futures.status();
  const Clip& future = futures->front();
  ASSERT_EQ(future.num_frames(), 3);
  EXPECT_EQ(future.frame_rate(), past.frame_rate());
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(future.root_position(frame), past.root_position(6));
    EXPECT_EQ(future.rotation(frame, 4).coeffs(), past.rotation(6, 4).coeffs());
  }
}

TEST(ConstantVelocityTest, ContinuesASteadyMotionExactly) {
  const Clip whole = SteadyClip(0, 20);
  const auto futures =
      FindBuiltInPredictor("constant-velocity")->Predict({{{SteadyClip(0, 8)}}}, 12, {});
  ASSERT_TRUE(futures.ok()) << futures.status();
  EXPECT_LT(LargestDifference(futures->front(), SteadyClip(8, 12)), 1e-6);
}

TEST(FloorsTest, BatchGivesWhatSingleCallsGive) {
  for (const std::string& name : BuiltInPredictorNames()) {
    const PredictorPtr predictor = FindBuiltInPredictor(name);
    const std::vector<Observation> batch = {{testing::SwingingClip(9, 120, 0.3, 1)},
                                            {testing::SwingingClip(30, 120, 0.3, 2)}};
    const auto together = predictor->Predict(batch, 5, {});
    ASSERT_TRUE(together.ok());
    for (int i = 0; i < 2; ++i) {
      const auto alone = predictor->Predict({&batch[i], 1}, 5, {});
      EXPECT_EQ(LargestDifference(together->at(i), alone->front()), 0);
    }
  }
}

TEST(FloorsTest, WhatTheyCannotAnswerIsRefusedWithTheField) {
  const PredictorPtr steady = FindBuiltInPredictor("constant-velocity");
  const Clip good = testing::SwingingClip(4), short_one = testing::SwingingClip(1);
  const Status few = steady->Predict({{{good}, {short_one}}}, 5, {}).status();
  EXPECT_EQ(base::ErrorReason(few), "TOO_FEW_FRAMES");
  EXPECT_EQ(base::ErrorField(few), "observations[1].past");
  EXPECT_EQ(base::ErrorReason(steady->Predict({{{good}}}, 0, {}).status()), "BAD_HORIZON");
  const motion::JointMask mask{std::vector<bool>(good.rotations().size(), true)};
  EXPECT_EQ(base::ErrorReason(steady->Predict({{{good, mask}}}, 2, {}).status()),
            "MASKS_NOT_SUPPORTED");
  const motion::JointMask small{{true, false}};
  EXPECT_EQ(base::ErrorReason(steady->Predict({{{good, small}}}, 2, {}).status()), "WRONG_SHAPE");
  base::RunContext cancelled;
  cancelled.cancellation.Cancel();
  EXPECT_EQ(steady->Predict({{{good}}}, 2, cancelled).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(PredictorRegistryTest, UnknownNameIsNull) {
  EXPECT_EQ(FindBuiltInPredictor("clairvoyant"), nullptr);
}

}  // namespace
}  // namespace poise::prediction
