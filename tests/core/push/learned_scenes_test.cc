// Scenes that nobody recorded (reference push.md sec. 12), by networks that have learned a little:
// what does not depend on how well they have learned holds already.
#include <gmock/gmock.h>

#include "core/motion/joint_roles.h"
#include "core/push/push_forecaster.h"
#include "core/push/standing_person.h"
#include "core/push/training/train_push.h"
#include "tests/core/push/fzj_data.h"

namespace poise::push {
namespace {

constexpr double kStrong = 65;            // [N s]
constexpr double kRadius = 0.15;          // [m] of a trunk
constexpr double kLargestOverlap = 0.05;  // [m]

// Learns for some seconds from takes of several people.
const PushForecaster& Forecaster() {
  static const std::unique_ptr<PushForecaster> forecaster = [] {
    PushTraining config;
    config.hip_members = config.pose_members = 1;
    config.hip_training.network = {.steps = 60, .batch_size = 8, .validate_every = 20};
    config.pose_training.network = {.steps = 40, .batch_size = 16, .validate_every = 20};
    base::RunContext context;
    context.seed = 1;
    const auto trained = TrainPush({.takes = testing::MultiTakes(), .config = config}, context);
    EXPECT_TRUE(trained.ok()) << trained.status();
    return *MakeLearnedForecaster(trained->model);
  }();
  return *forecaster;
}

ScenePerson PersonAt(double x, double y) {
  const motion::Clip& clip = StandingPerson();
  ScenePerson person = *PersonOf(clip, 0, *motion::JointRoles::Detect(*clip.skeleton()));
  person.mass_kg = 75;
  person.hip += Vec3(x, y, 0);
  person.pendulum.position.head<2>() += Eigen::Vector2d(x, y);
  return person;
}

PushScene PushedScene(double impulse) {
  constexpr int kFrames = 12;
  return {.people = {},
          .pushes = {{.frames = kFrames, .force_n = {impulse * kFrameRate / kFrames, 0}}},
          .frames = 181};
}

PushScene LineOfTen(double impulse) {
  PushScene scene = PushedScene(impulse);
  for (int i = 0; i < 10; ++i) scene.people.push_back(PersonAt(0.35 * i, 0));
  return scene;
}

// Rows of 1, 3, 5, 3, 1 people; the rear one is pushed.
PushScene DiamondOfThirteen(double impulse) {
  PushScene scene = PushedScene(impulse);
  for (int row = 0; row < 5; ++row) {
    const int side = std::min(row, 4 - row);
    for (int i = -side; i <= side; ++i) scene.people.push_back(PersonAt(0.45 * row, 0.45 * i));
  }
  return scene;
}

std::vector<PushFrame> Roll(const PushScene& scene) {
  const auto rollout = Forecaster().Start(scene);
  std::vector<PushFrame> frames;
  for (int frame = 0; frame < scene.frames; ++frame) {
    const auto next = rollout->Next();
    EXPECT_TRUE(next.ok()) << next.status();
    frames.push_back(**next);
  }
  return frames;
}

double LeastDistance(const std::vector<PushFrame>& frames) {
  double least = 1e9;
  for (const PushFrame& frame : frames) {
    for (int i = 0; i < frame.hips.rows(); ++i) {
      for (int j = 0; j < i; ++j) {
        least =
            std::min(least, (frame.hips.row(i) - frame.hips.row(j)).leftCols<2>().matrix().norm());
      }
    }
  }
  return least;
}

Vec3 Toe(const PushScene& scene, const PushFrame& frame, size_t person, int foot) {
  return frame.hips.row(person).matrix().transpose() +
         Turned(scene.people[person].shape, frame.turns[person])[kToes[foot]];
}

void ExpectFeetStand(const PushScene& scene, const std::vector<PushFrame>& frames) {
  for (size_t i = 0; i < scene.people.size(); ++i) {
    int sliding = 0;
    for (size_t frame = 1; frame < frames.size(); ++frame) {
      double least = 1;
      for (int foot = 0; foot < 2; ++foot) {
        const Vec3 now = Toe(scene, frames[frame], i, foot);
        least = std::min(least, (now - Toe(scene, frames[frame - 1], i, foot)).norm());
      }
      sliding += least > 1e-6 ? 1 : 0;
    }
    // A leg that does not reach the ground drags its toe.
    EXPECT_LE(sliding, 5) << "person " << i;
  }
}

TEST(LearnedScenesTest, APushTravelsAlongALineOfTen) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushScene scene = LineOfTen(kStrong);
  const auto frames = Roll(scene);
  const std::vector<int>& onsets = frames.back().onset_frames;
  ASSERT_GE(onsets[0], 0);
  for (int i = 1; i < 10; ++i) {
    ASSERT_GE(onsets[i], 0) << i;
    // After so little learning two neighbours may stir almost at once.
    EXPECT_GE(onsets[i], onsets[i - 1] - 2) << i;
  }
  EXPECT_GT(LeastDistance(frames), 2 * kRadius - kLargestOverlap);
  ExpectFeetStand(scene, frames);
}

TEST(LearnedScenesTest, AStrongerPushIsNeverFeltLater) {
  POISE_REQUIRE_DATA("fzj_push");
  std::vector<int> before(10, 1 << 20);
  for (const double impulse : {30.0, 45.0, 65.0, 90.0}) {
    const std::vector<int> onsets = Roll(LineOfTen(impulse)).back().onset_frames;
    for (int i = 0; i < 10; ++i) {
      const int onset = onsets[i] < 0 ? 1 << 20 : onsets[i];
      EXPECT_LE(onset, before[i]) << "person " << i << " at " << impulse << " N s";
      before[i] = onset;
    }
  }
}

TEST(LearnedScenesTest, NobodyInADiamondIsRunThrough) {
  POISE_REQUIRE_DATA("fzj_push");
  const PushScene scene = DiamondOfThirteen(kStrong);
  const auto frames = Roll(scene);
  EXPECT_GT(LeastDistance(frames), 2 * kRadius - kLargestOverlap);
  const std::vector<int>& onsets = frames.back().onset_frames;
  for (const auto& [behind, ahead] : {std::pair(0, 2), std::pair(2, 6), std::pair(6, 10)}) {
    EXPECT_GE(onsets[behind], 0);
    EXPECT_GE(onsets[ahead], onsets[behind]);
  }
  ExpectFeetStand(scene, frames);
}

}  // namespace
}  // namespace poise::push
