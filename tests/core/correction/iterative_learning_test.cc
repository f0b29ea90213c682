#include "core/correction/tracking/iterative_learning.h"

#include <gtest/gtest.h>

#include "tests/core/correction/tracked_clip.h"
#include "tests/support/data_files.h"
#include "tests/support/sanitizer.h"

namespace poise::correction {
namespace {

MotionTracker MakeTracker(const TrackedClip& clip, const TrackingConfig& config = {}) {
  return std::move(MotionTracker::Create(clip.model, {}, clip.reference.frame_rate(), config))
      .value();
}

TrackingConfig ZeroPolicy() { return *TrackingConfig::FromPreset("paper"); }

TEST(IterativeLearningTest, ALaggingControllerLearnsToBeOnTime) {
  const TrackedClip clip = Prepare(SwayingClip(3));
  MotionTracker tracker = MakeTracker(clip, ZeroPolicy());
  const Learned learned =
      *LearnIteratively(tracker, clip.reference, *LearningConfig::FromPreset("paper"));
  EXPECT_EQ(learned.scores.size(), 8u);
  EXPECT_LT(learned.best.score.pose_error_rad, 0.7 * learned.scores[0].pose_error_rad);
  EXPECT_GT(learned.best.score.reward_normalised, learned.scores[0].reward_normalised);
}

TEST(IterativeLearningTest, TheFirstRolloutIsTheControllerWithoutLearning) {
  const TrackedClip clip = Prepare(SwayingClip(2));
  MotionTracker tracker = MakeTracker(clip);
  const double alone = tracker.Track(clip.reference)->score.reward_total;
  LearningConfig config;
  config.rollouts = 3;
  const Learned learned = *LearnIteratively(tracker, clip.reference, config);
  EXPECT_EQ(learned.scores[0].reward_total, alone);
  EXPECT_NE(learned.scores[2].reward_total, alone);
}

TEST(IterativeLearningTest, WhatLegsHaveLearnedTheResidualNeedNotHold) {
  const char* name = "hdm05/throwBasketball/HDM_bd_throwBasketball_001_120.amc";
  POISE_REQUIRE_DATA(name);
  const TrackedClip clip = ReadAndPrepare(testing::DataPath(name));
  MotionTracker tracker = MakeTracker(clip);
  const Learned learned = *LearnIteratively(tracker, clip.reference, {});
  const TrackingScore &first = learned.scores[0], &best = learned.best.score;
  EXPECT_TRUE(best.completed);
  EXPECT_LT(best.residual_force_mean_bw, 0.7 * first.residual_force_mean_bw);
  EXPECT_GE(best.reward_normalised, first.reward_normalised);
}

TEST(IterativeLearningTest, TheBestSoFarComesBackAtTheDeadline) {
  const TrackedClip clip = Prepare(SwayingClip(3));
  MotionTracker tracker = MakeTracker(clip);
  LearningConfig config;
  config.rollouts = 1000;
  base::RunContext context;
  int reports = 0;
  // The deadline comes during the fourth rollout.
  context.progress = [&](const base::Progress& progress) {
    reports = static_cast<int>(progress.step);
    if (progress.step == 3) context.deadline = absl::InfinitePast();
  };
  const Learned learned = *LearnIteratively(tracker, clip.reference, config, context);
  EXPECT_TRUE(learned.timed_out);
  EXPECT_EQ(learned.scores.size(), 3u);
  EXPECT_EQ(reports, 3);
  EXPECT_TRUE(learned.best.score.completed);
}

TEST(IterativeLearningTest, ACancelledOneReturnsNothing) {
  const TrackedClip clip = Prepare(SwayingClip(1));
  MotionTracker tracker = MakeTracker(clip);
  base::RunContext context;
  context.progress = [&](const base::Progress&) { context.cancellation.Cancel(); };
  EXPECT_EQ(LearnIteratively(tracker, clip.reference, {}, context).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(IterativeLearningTest, EightRolloutsFromTheZeroPolicyCompleteTheKicks) {
  POISE_SKIP_WHERE_INSTRUMENTED();
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  int completed = 0;
  for (const auto& file : testing::DataFiles("hdm05/kickLFront1Reps", {".amc"})) {
    const TrackedClip clip = ReadAndPrepare(file);
    MotionTracker tracker = MakeTracker(clip, ZeroPolicy());
    const auto learned =
        LearnIteratively(tracker, clip.reference, *LearningConfig::FromPreset("paper"));
    completed += learned.ok() && learned->best.score.completed;
  }
  EXPECT_GE(completed, 26);
}

TEST(IterativeLearningTest, LearningOnRealJogsLowersTheForceAndNotTheReward) {
  const std::string folder = "hdm05/jogLeftCircle4StepsRstart";
  POISE_SKIP_WHERE_INSTRUMENTED();
  POISE_REQUIRE_DATA(folder);
  double force_before = 0, force_after = 0;
  for (const auto& file : testing::DataFiles(folder, {".amc"})) {
    const TrackedClip clip = ReadAndPrepare(file);
    MotionTracker tracker = MakeTracker(clip);
    const Learned learned = *LearnIteratively(tracker, clip.reference, {});
    EXPECT_GE(learned.best.score.reward_normalised, learned.scores[0].reward_normalised);
    force_before += learned.scores[0].residual_force_mean_bw;
    force_after += learned.best.score.residual_force_mean_bw;
  }
  EXPECT_LT(force_after, 0.9 * force_before);
}

}  // namespace
}  // namespace poise::correction
