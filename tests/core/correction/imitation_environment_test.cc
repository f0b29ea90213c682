#include "core/correction/imitation/imitation_environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/correction/tracked_clip.h"

namespace poise::correction {
namespace {

constexpr double kRate = 120;
constexpr int kHold = 4;  // frames an action is held at 30 Hz

motion::JointRoles RolesOf(const motion::Clip& clip) {
  return *motion::JointRoles::Detect(*clip.skeleton());
}

// Variants that differ in how deep the arms sway.
StatusOr<motion::Clip> Variant(uint64_t draw) {
  motion::Clip clip = SwayingClip(2);
  const int arm = RolesOf(clip).joint(motion::JointRole::kLeftElbow);
  const double angle = 0.001 * static_cast<double>(draw % 500);
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    clip.rotation(frame, arm) = math::FromRotationVector(Vec3(0, angle, 0));
  }
  return clip;
}

Corrector MakeCorrector(const CorrectionConfig& config = {}) {
  const motion::Clip clip = SwayingClip(2);
  return std::move(Corrector::Create(clip, RolesOf(clip), config)).value();
}

struct Task {
  std::unique_ptr<ImitationEnvironment> environment;
  base::Random random{7};
  std::vector<float> observation, action;
};

Task MakeTask(const ImitationConfig& config = {}, const CorrectionConfig& correction = {}) {
  Task task;
  task.environment =
      *ImitationEnvironment::Create(MakeCorrector(correction), Variant, kRate, config);
  task.observation.resize(task.environment->observation_size());
  task.action.resize(task.environment->action_size(), 0.0f);
  return task;
}

ImitationConfig FromTheStart() {
  ImitationConfig config;
  config.start_share = 1;
  return config;
}

TEST(ImitationEnvironmentTest, WithoutActionsTheBodyDoesWhatTheTrackerWithoutLearningDoes) {
  Task task = MakeTask(FromTheStart());
  ASSERT_TRUE(task.environment->Reset(task.random, task.observation).ok());
  const Corrector corrector = MakeCorrector();
  MotionTracker tracker = *corrector.Tracker(kRate);
  const Recording recording = *tracker.Track(task.environment->reference());
  for (int frame = kHold; frame < recording.clip.num_frames(); frame += kHold) {
    const rl::Transition step = *task.environment->Step(task.action, task.observation);
    EXPECT_EQ(task.environment->episode().world().state().root_position,
              recording.clip.root_position(frame));
    EXPECT_FALSE(step.terminated);
    EXPECT_EQ(step.truncated, frame == recording.clip.num_frames() - 1);
  }
}

TEST(ImitationEnvironmentTest, TheRewardIsTheImitationsLessTheForce) {
  Task free = MakeTask(FromTheStart());
  ImitationConfig config = FromTheStart();
  config.force_weight = 0;
  config.torque_weight = 0;
  Task plain = MakeTask(config);
  ASSERT_TRUE(free.environment->Reset(free.random, free.observation).ok());
  ASSERT_TRUE(plain.environment->Reset(plain.random, plain.observation).ok());
  for (int step = 0; step < 40; ++step) {
    const float reward = plain.environment->Step(plain.action, plain.observation)->reward;
    EXPECT_GT(reward, 0.8);
    EXPECT_LE(reward, 1);
    const float less = reward - free.environment->Step(free.action, free.observation)->reward;
    const physics::Effort& effort = plain.environment->episode().world().effort();
    EXPECT_GE(less, 0);
    // The frames of an action have similar forces.
    EXPECT_NEAR(
        less, 0.5 * effort.residual_force.norm() / 441 + 0.2 * effort.residual_torque.norm() / 100,
        0.02);
  }
}

TEST(ImitationEnvironmentTest, AQuarterStartsAtTheBeginningTheOthersAnywhere) {
  Task task = MakeTask();
  int first = 0, late = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(task.environment->Reset(task.random, task.observation).ok());
    first += task.environment->episode().frame() == 0;
    late += task.environment->episode().frame() > 120;
  }
  EXPECT_NEAR(first, 100, 30);
  EXPECT_NEAR(late, 150, 35);
}

TEST(ImitationEnvironmentTest, TheSameDrawsAndActionsGiveTheSameEpisode) {
  Task a = MakeTask(), b = MakeTask();
  ASSERT_TRUE(b.environment->Reset(b.random, b.observation).ok());  // another episode before
  b.random = base::Random(7);
  for (int episode = 0; episode < 3; ++episode) {
    ASSERT_TRUE(a.environment->Reset(a.random, a.observation).ok());
    ASSERT_TRUE(b.environment->Reset(b.random, b.observation).ok());
    for (int step = 0;; ++step) {
      EXPECT_EQ(a.observation, b.observation);
      a.action.assign(a.action.size(), 0.05f * std::sin(0.3f * step));
      const rl::Transition done = *a.environment->Step(a.action, a.observation);
      EXPECT_EQ(done.reward, b.environment->Step(a.action, b.observation)->reward);
      if (done.terminated || done.truncated) break;
    }
  }
}

TEST(ImitationEnvironmentTest, NoEpisodeShowsAHeldOutVariant) {
  ImitationConfig config;
  config.held_out = 1000;
  std::vector<uint64_t> draws;
  auto environment = *ImitationEnvironment::Create(
      MakeCorrector(),
      [&](uint64_t draw) {
        draws.push_back(draw);
        return Variant(draw);
      },
      kRate, config);
  base::Random random(1);
  std::vector<float> observation(environment->observation_size());
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(environment->Reset(random, observation).ok());
  for (const uint64_t draw : draws) {
    EXPECT_GE(draw, 1000u);
    EXPECT_LT(draw, kVariantDraws);
  }
}

TEST(ImitationEnvironmentTest, AFallEndsTheEpisodeAndEarnsNothing) {
  ImitationConfig config = FromTheStart();
  config.residual = "none";
  Task task = MakeTask(config);
  ASSERT_TRUE(task.environment->Reset(task.random, task.observation).ok());
  // Bends hips and knees until nothing holds the body.
  task.action.assign(task.action.size(), 1.0f);
  rl::Transition step;
  for (int i = 0; i < 60 && !step.terminated && !step.truncated; ++i) {
    step = *task.environment->Step(task.action, task.observation);
    for (const float value : task.observation) EXPECT_TRUE(std::isfinite(value));
  }
  EXPECT_TRUE(step.terminated);
  EXPECT_EQ(step.reward, 0);
}

// Mean outer force over the first second, all actions `value`.
double MeanForce(const std::string& residual, float value) {
  ImitationConfig config = FromTheStart();
  config.residual = residual;
  Task task = MakeTask(config);
  EXPECT_TRUE(task.environment->Reset(task.random, task.observation).ok());
  task.action.back() = value;
  double sum = 0;
  for (int step = 0; step < 15; ++step) {
    EXPECT_TRUE(task.environment->Step(task.action, task.observation).ok());
    const physics::Effort& effort = task.environment->episode().world().effort();
    sum += effort.residual_force.norm() + effort.residual_torque.norm();
  }
  return sum / 15;
}

TEST(ImitationEnvironmentTest, EachKindOfResidualIsWhatItSays) {
  EXPECT_EQ(MeanForce("none", 0), 0);
  EXPECT_EQ(MeanForce("rfc", 0), 0);
  EXPECT_NEAR(MeanForce("rfc", 0.2), 20, 1e-3);  // about one axis; 100 N m per unit
  EXPECT_GT(MeanForce("pd", 0), 0);
  EXPECT_EQ(MeanForce("pd_scaled", -1), 0);
  EXPECT_EQ(MeanForce("pd_scaled", 0), MeanForce("pd", 0));
  EXPECT_EQ(MeanForce("pd_scaled", 1), MeanForce("pd", 0));  // never more
  EXPECT_NE(MeanForce("pd_rfc", 0.2), MeanForce("pd", 0));
}

TEST(ImitationEnvironmentTest, TheObservationDoesNotKnowWhereTheMotionHappens) {
  const auto turned = [](uint64_t draw) -> StatusOr<motion::Clip> {
    motion::Clip clip = *Variant(draw);
    const math::Quat turn = math::FromRotationVector(Vec3(0, 1.1, 0));
    for (int frame = 0; frame < clip.num_frames(); ++frame) {
      clip.root_position(frame) = turn * clip.root_position(frame) + Vec3(3, 0, -1);
      clip.rotation(frame, 0) = turn * clip.rotation(frame, 0);
    }
    return clip;
  };
  Task here = MakeTask(FromTheStart());
  auto there = *ImitationEnvironment::Create(MakeCorrector(), turned, kRate, FromTheStart());
  base::Random random(7);
  std::vector<float> observation(there->observation_size());
  ASSERT_TRUE(here.environment->Reset(here.random, here.observation).ok());
  ASSERT_TRUE(there->Reset(random, observation).ok());
  const auto compare = [&](double tolerance) {
    for (size_t i = 0; i < observation.size(); ++i) {
      EXPECT_NEAR(observation[i], here.observation[i], tolerance) << "number " << i;
    }
  };
  compare(1e-5);
  here.action.assign(here.action.size(), 0.02f);
  ASSERT_TRUE(here.environment->Step(here.action, here.observation).ok());
  ASSERT_TRUE(there->Step(here.action, observation).ok());
  compare(0.04);  // the solver's friction has axes of its own
}

TEST(ImitationConfigTest, PresetsAndBadValues) {
  EXPECT_TRUE(ImitationConfig().Validate().ok());
  EXPECT_EQ(ImitationConfig::FromPreset("paper")->ppo.actor.hidden_layers, "1024-512");
  EXPECT_EQ(base::ErrorReason(ImitationConfig::FromPreset("best").status()), "UNKNOWN_PRESET");
  ImitationConfig config;
  config.residual = "magic";
  EXPECT_EQ(base::ErrorField(config.Validate()), "residual");
}

}  // namespace
}  // namespace poise::correction
