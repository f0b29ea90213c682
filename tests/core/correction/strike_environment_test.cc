#include "core/correction/imitation/strike_environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/correction/imitation/policy_rollout.h"
#include "tests/core/correction/tracked_clip.h"

namespace poise::correction {
namespace {

constexpr int kHand = static_cast<int>(motion::JointRole::kLeftWrist);

Corrector MakeCorrector() {
  const motion::Clip clip = SwayingClip(2);
  return *Corrector::Create(clip, *motion::JointRoles::Detect(*clip.skeleton()));
}

Vec3 HandOf(const TrackingEpisode& episode) {
  return physics::ComputeFrames(episode.model().articulation(), episode.world().state())
      .positions[kHand];
}

struct Task {
  std::unique_ptr<StrikeEnvironment> environment;
  base::Random random{7};
  std::vector<float> observation, action;
};

Task MakeTask(const StrikeConfig& config, const Vec3& target) {
  ImitationConfig imitation;
  imitation.start_share = 1;
  Task task;
  task.environment = *StrikeEnvironment::Create(
      MakeCorrector(), SwayingClip(2), kHand, [target](uint64_t) { return target; }, imitation,
      config);
  task.observation.resize(task.environment->observation_size());
  task.action.resize(task.environment->action_size(), 0.0f);
  EXPECT_TRUE(task.environment->Reset(task.random, task.observation).ok());
  return task;
}

double Step(Task& task) { return task.environment->Step(task.action, task.observation)->reward; }

TEST(StrikeRewardTest, IsThatOfTheFormula) {
  const StrikeConfig config;
  EXPECT_DOUBLE_EQ(StrikeReward(config, 0, false), 1);
  EXPECT_DOUBLE_EQ(StrikeReward(config, 0.5, false), std::exp(-1.0));
  EXPECT_DOUBLE_EQ(StrikeReward(config, 1, false), std::exp(-4.0));
  EXPECT_DOUBLE_EQ(StrikeReward(config, 1, true), 1);
}

TEST(StrikeEnvironmentTest, TheRewardIsTheMeanOfBothByWeight) {
  const Vec3 target(0.3, 1.6, 0.8);
  StrikeConfig none, some, all;
  none.weight = 0;
  all.weight = 1;
  some.hit_radius_m = all.hit_radius_m = 0;
  Task imitation = MakeTask(none, target), both = MakeTask(some, target),
       strike = MakeTask(all, target);
  for (int step = 0; step < 30; ++step) {
    const double r = Step(imitation), s = Step(strike);
    EXPECT_NEAR(Step(both), 0.7 * r + 0.3 * s, 1e-6);
    const double distance = (HandOf(strike.environment->episode()) - target).norm();
    EXPECT_NEAR(s, std::exp(-4 * distance * distance), 1e-6);
    EXPECT_GT(std::abs(r - s), 0.1);  // so the weight changes what is earned
  }
}

TEST(StrikeEnvironmentTest, AStruckTargetEarnsAllUntilTheEnd) {
  StrikeConfig config;
  config.weight = 1;
  config.hit_radius_m = 0.05;
  Task task = MakeTask(config, Vec3(0, 0, 0));
  const Vec3 hand = HandOf(task.environment->episode());
  task = MakeTask(config, hand);  // where the hand is before the arms sway
  EXPECT_TRUE(task.environment->strike().struck());
  for (int step = 0; step < 55; ++step) EXPECT_EQ(Step(task), 1);
  EXPECT_GT((HandOf(task.environment->episode()) - hand).norm(), 0.2);  // and is no more
}

TEST(StrikeEnvironmentTest, TheObservationSaysWhereTheTargetIs) {
  const Vec3 target(0.3, 1.6, 0.8);
  Task task = MakeTask({}, target);
  const std::span<const float> seen =
      std::span<const float>(task.observation).last(Strike::kObservationSize);
  EXPECT_NEAR(Vec3(seen[3], seen[4], seen[5]).norm(),
              (target - HandOf(task.environment->episode())).norm(), 1e-6);
  EXPECT_NEAR(seen[1], target.y() - task.environment->episode().world().state().root_position.y(),
              1e-6);
  EXPECT_EQ(seen[6], 0);
}

TEST(StrikeEnvironmentTest, EpisodesDrawTargetsThatAreNotHeldOut) {
  ImitationConfig imitation;
  imitation.held_out = 1000;
  std::vector<uint64_t> draws;
  auto environment = *StrikeEnvironment::Create(MakeCorrector(), SwayingClip(2), kHand,
                                                [&](uint64_t draw) {
                                                  draws.push_back(draw);
                                                  return Vec3(0, 1, 0);
                                                },
                                                imitation, {});
  base::Random random(1);
  std::vector<float> observation(environment->observation_size());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(environment->Reset(random, observation).ok());
  ASSERT_EQ(draws.size(), 20u);
  for (const uint64_t draw : draws) {
    EXPECT_GE(draw, 1000u);
    EXPECT_LT(draw, kVariantDraws);
  }
}

// A policy that is played sees the strike where it saw it in training.
TEST(StrikeEnvironmentTest, APlayedPolicySeesTheStrikeBehindTheImitation) {
  const Corrector corrector = MakeCorrector();
  const ImitationConfig config;
  const ImitationSpaces spaces(corrector.shared_model(), corrector.config().tracking, config);
  const ReferenceMotion reference = *corrector.Reference(SwayingClip(2));
  // Turns the first joint by 0.1 rad once the target has been struck, and does nothing else.
  const int inputs = spaces.observation_size() + Strike::kObservationSize;
  Eigen::MatrixXf weight = Eigen::MatrixXf::Zero(spaces.action_size(), inputs);
  weight(0, inputs - 1) = 0.1f;
  const rl::Policy policy(*rl::PolicyNetwork::Create(
      {.mean = std::vector<float>(inputs), .inverse_deviation = std::vector<float>(inputs, 1.0f)},
      {{weight, Eigen::VectorXf::Zero(spaces.action_size())}}, rl::Activation::kTanh));
  TrackingEpisode episode =
      *TrackingEpisode::Create(corrector.shared_model(), corrector.config().world,
                               reference.frame_rate(), corrector.config().tracking);
  episode.Start(reference);
  for (const bool near : {false, true}) {
    Strike strike({}, kHand, HandOf(episode) + Vec3(0, near ? 0.1 : 1, 0));
    const Commander commander =
        PolicyCommander(spaces, config, reference, policy, strike.Extra(reference));
    EXPECT_NEAR(commander(episode).offset.tail<physics::kMaxSpeeds - 6>().norm(), near ? 0.1 : 0,
                1e-6);
    EXPECT_EQ(strike.struck(), near);
  }
}

TEST(StrikeEnvironmentTest, RefusesBadConfigs) {
  StrikeConfig config;
  config.weight = 2;
  const auto environment = StrikeEnvironment::Create(
      MakeCorrector(), SwayingClip(2), kHand, [](uint64_t) { return Vec3(0, 1, 0); }, {}, config);
  EXPECT_EQ(base::ErrorField(environment.status()), "weight");
}

}  // namespace
}  // namespace poise::correction
