#include "core/correction/tracking/motion_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/correction/tracked_clip.h"
#include "tests/support/data_files.h"

namespace poise::correction {
namespace {

StatusOr<Recording> Imitate(const TrackedClip& clip, const TrackingConfig& config = {},
                            const physics::WorldConfig& world = {}) {
  POISE_ASSIGN_OR_RETURN(
      MotionTracker tracker,
      MotionTracker::Create(clip.model, world, clip.reference.frame_rate(), config));
  return tracker.Track(clip.reference);
}

TEST(MotionTrackerTest, ImitatesASwayInBothEngines) {
  const TrackedClip clip = Prepare(SwayingClip(3));
  for (const char* engine : {"own", "bullet"}) {
    physics::WorldConfig world;
    world.engine = engine;
    const Recording recording = *Imitate(clip, {}, world);
    EXPECT_TRUE(recording.score.completed);
    EXPECT_EQ(recording.score.completion, 1);
    EXPECT_GT(recording.score.reward_normalised, 0.9);
    EXPECT_LT(recording.score.residual_force_mean_bw, 0.1);
    EXPECT_LT(recording.score.pelvis_error_max_m, 0.05);
    EXPECT_EQ(recording.clip.num_frames(), clip.reference.num_frames());
  }
}

TEST(MotionTrackerTest, TheGroundCarriesAStandingBodyEvenly) {
  const TrackedClip clip = Prepare(SwayingClip(2));
  TrackingEpisode episode =
      *TrackingEpisode::Create(clip.model, {}, clip.reference.frame_rate(), {});
  episode.Start(clip.reference);
  const double weight = clip.model->total_mass() * -episode.world().gravity().y();
  for (int frame = 0; frame < 110; ++frame) {
    ASSERT_TRUE(episode.Advance().ok());
    if (frame < 30) continue;  // it settles
    double load = 0;
    for (const physics::ContactPoint& contact : episode.world().contacts()) {
      load += contact.impulse[0] / episode.world().step_s();
    }
    EXPECT_NEAR(load / weight, 1, 0.02) << frame;
  }
}

// How late the body's joints are, by least squares over all of them.
double LateBy(const ReferenceMotion& reference, const Recording& recording) {
  double lag = 0, speed2 = 0;
  for (int frame = 0; frame < reference.num_frames(); ++frame) {
    const auto speeds = reference.frame(frame).speeds.tail<physics::kMaxSpeeds - 6>();
    lag += speeds.dot(recording.lags[frame].tail<physics::kMaxSpeeds - 6>());
    speed2 += speeds.squaredNorm();
  }
  return lag / speed2;
}

TEST(MotionTrackerTest, JointsAreNotLateByTheControllersStep) {
  const TrackedClip clip = Prepare(SwayingClip(3));
  for (const double rate_hz : {240.0, 600.0}) {
    physics::WorldConfig world;
    world.rate_hz = rate_hz;
    EXPECT_NEAR(LateBy(clip.reference, *Imitate(clip, {}, world)), 0, 0.2 / rate_hz) << rate_hz;
  }
}

TEST(MotionTrackerTest, TheSameMotionGivesTheSameRecording) {
  const TrackedClip clip = Prepare(SwayingClip(2));
  const Recording first = *Imitate(clip), second = *Imitate(clip);
  for (int frame = 0; frame < first.clip.num_frames(); ++frame) {
    EXPECT_EQ(first.clip.root_position(frame), second.clip.root_position(frame));
  }
  EXPECT_EQ(first.score.reward_total, second.score.reward_total);
}

TEST(MotionTrackerTest, AFallScoresNothingAfterItAndIsRecordedToTheEnd) {
  // Leans over until nobody can hold it who is not held himself.
  motion::Clip leaning = SwayingClip(3);
  for (int frame = 0; frame < leaning.num_frames(); ++frame) {
    const double lean = std::min(frame / 120.0, 1.2);
    leaning.rotation(frame, 0) = math::FromRotationVector(Vec3(lean, 0, 0));
    leaning.root_position(frame) += 0.95 * Vec3(0, std::cos(lean) - 1, std::sin(lean));
  }
  const TrackedClip clip = Prepare(leaning);
  TrackingConfig config;
  config.residual_factor = 0;
  const Recording recording = *Imitate(clip, config);
  EXPECT_FALSE(recording.score.completed);
  EXPECT_LT(recording.score.completion, 1);
  EXPECT_LT(recording.score.reward_normalised, recording.score.reward_imitation);
  EXPECT_EQ(recording.clip.num_frames(), 361);
  EXPECT_EQ(recording.score.residual_force_peak_bw, 0);
}

TEST(MotionTrackerTest, EachPartOfTheControllerChangesTheScore) {
  const TrackedClip clip = Prepare(SwayingClip(3));
  const double whole = Imitate(clip)->score.reward_normalised;
  TrackingConfig still, plain, loose;
  still.target_velocity = false;
  plain.feed_forward = false;
  loose.residual_factor = 0.5;
  for (const TrackingConfig& config : {still, plain, loose}) {
    EXPECT_NE(Imitate(clip, config)->score.reward_normalised, whole);
  }
}

TEST(MotionTrackerTest, StopsWhenAskedTo) {
  const TrackedClip clip = Prepare(SwayingClip(1));
  MotionTracker tracker = std::move(MotionTracker::Create(clip.model, {}, 120)).value();
  base::RunContext context;
  context.cancellation.Cancel();
  EXPECT_EQ(tracker.Track(clip.reference, context).status().code(), absl::StatusCode::kCancelled);
}

struct ClassScore {
  int clips = 0, completed = 0;
  double reward_normalised = 0, force = 0;  // means over clips
};

ClassScore ScoreClass(const std::string& folder, const TrackingConfig& config,
                      const physics::WorldConfig& world, const ReferenceConfig& reference = {}) {
  ClassScore sum;
  for (const auto& file : testing::DataFiles(folder, {".amc"})) {
    ++sum.clips;
    const auto recording = Imitate(ReadAndPrepare(file, reference), config, world);
    if (!recording.ok()) continue;
    sum.completed += recording->score.completed;
    sum.reward_normalised += recording->score.reward_normalised;
    sum.force += recording->score.residual_force_mean_bw;
  }
  sum.reward_normalised /= sum.clips;
  sum.force /= sum.clips;
  return sum;
}

TEST(RealKicksTest, ThePapersZeroPolicyFallsInSome) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  const ClassScore score =
      ScoreClass("hdm05/kickLFront1Reps", *TrackingConfig::FromPreset("paper"),
                 *physics::WorldConfig::FromPreset("paper"), *ReferenceConfig::FromPreset("paper"));
  EXPECT_EQ(score.clips, 28);
  EXPECT_GE(score.completed, 18);
  EXPECT_LE(score.completed, 26);
  EXPECT_GT(score.reward_normalised, 0.64);
  EXPECT_LT(score.reward_normalised, 0.76);
  EXPECT_NEAR(score.force, 0.19, 0.02);
}

// What the controller without learning must reach over all clips of a class.
struct Required {
  const char* folder;
  double completed;  // part of the clips
  double reward_normalised;
  double force;  // [body weights] mean
};

class RealClassTest : public ::testing::TestWithParam<Required> {};

TEST_P(RealClassTest, IsImitatedWithoutLearning) {
  const std::string folder = std::string("hdm05/") + GetParam().folder;
  POISE_REQUIRE_DATA(folder);
  const ClassScore score = ScoreClass(folder, {}, {});
  EXPECT_GE(score.completed, GetParam().completed * score.clips);
  EXPECT_GE(score.reward_normalised, GetParam().reward_normalised);
  EXPECT_LE(score.force, GetParam().force);
}

INSTANTIATE_TEST_SUITE_P(Classes, RealClassTest,
                         ::testing::Values(Required{"kickLFront1Reps", 1, 0.92, 0.1},
                                           Required{"jogLeftCircle4StepsRstart", 0.95, 0.8, 0.2},
                                           Required{"grabHighR", 1, 0.9, 0.1},
                                           Required{"depositFloorR", 0.95, 0.9, 0.2},
                                           Required{"sneak2StepsLStart", 1, 0.9, 0.2},
                                           Required{"throwBasketball", 1, 0.9, 0.2},
                                           Required{"hopBothLegs1hops", 1, 0.9, 0.2}));

}  // namespace
}  // namespace poise::correction
