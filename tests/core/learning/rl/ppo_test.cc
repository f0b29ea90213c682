#include "core/learning/rl/ppo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/core/learning/rl/linear_task.h"
#include "tests/core/learning/rl/scripted_task.h"

namespace poise::rl {
namespace {

using testing::HasSubstr;

constexpr int kEnvironments = 16;

PpoConfig SmallConfig() {
  PpoConfig config;
  config.actor.hidden_layers = config.critic.hidden_layers = "16-16";
  config.samples_per_update = 320;
  config.warmup_samples = 64;
  config.minibatch = 64;
  config.epochs = 2;
  config.noise = 0.3;
  config.noise_end = 0.1;
  config.noise_samples = 1000;
  config.threads = 2;
  return config;
}

Ppo MakePpo(const PpoConfig& config, uint64_t seed = 1) {
  auto ppo = Ppo::Create(LinearTask::Make(kEnvironments), config, seed);
  EXPECT_TRUE(ppo.ok()) << ppo.status();
  return *std::move(ppo);
}

// The state after some iterations: equal bytes are equal weights, optimisers and counters.
std::string StateAfter(Ppo& ppo, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    const auto report = ppo.Iterate();
    EXPECT_TRUE(report.ok()) << report.status();
  }
  return ppo.Save();
}

// Mean discounted cost of a policy over many starts, as a multiple of the least possible one.
double CostRatio(Policy policy, double discount) {
  constexpr int kStarts = 200, kSteps = 200;
  const auto least = LinearTask::LeastCost(discount);
  double cost = 0, least_cost = 0;
  base::Random random(99);
  std::array<float, LinearTask::kStates> observation;
  std::array<float, LinearTask::kActions> action;
  for (int start = 0; start < kStarts; ++start) {
    LinearTask::State state;
    for (double& value : state) value = random.Normal();
    least_cost += state.dot(least * state);
    double weight = 1;
    for (int step = 0; step < kSteps; ++step, weight *= discount) {
      LinearTask::Observe(state, observation);
      policy.Act(observation, action);
      const LinearTask::Action push(action[0], action[1]);
      cost += weight * LinearTask::Cost(state, push);
      state = LinearTask::Next(state, push);
    }
  }
  return cost / least_cost;
}

TEST(PpoTest, ComesWithinThreePercentOfTheBestPolicyOfALinearQuadraticTask) {
  constexpr int kIterations = 120;
  PpoConfig config;
  config.actor.hidden_layers = "";  // the best policy is linear
  config.actor.learning_rate = 3e-2;
  config.critic.hidden_layers = "64-64";
  config.critic.learning_rate = 3e-3;
  config.learning_rate_samples = config.noise_samples = 300'000;
  config.learning_rate_end = 0.05;
  config.noise = 0.3;
  config.noise_end = 0.1;
  Ppo ppo = MakePpo(config);
  ASSERT_GT(CostRatio(ppo.policy(), config.discount), 5);
  StateAfter(ppo, kIterations);
  const double ratio = CostRatio(ppo.policy(), config.discount);
  EXPECT_LT(ratio, 1.03);
  EXPECT_GE(ratio, 1) << "nothing is better than the best";
}

TEST(PpoTest, LearnsTheSameWhateverTheThreads) {
  PpoConfig config = SmallConfig();
  Ppo one = MakePpo(config);
  config.threads = 1;
  Ppo other = MakePpo(config);
  EXPECT_EQ(StateAfter(one, 4), StateAfter(other, 4));
  config.environments_per_task = 1;
  config.threads = 3;
  Ppo third = MakePpo(config);
  StateAfter(third, 4);
  std::array<float, LinearTask::kStates> observation = {1, 2, 3, 4};
  std::array<float, LinearTask::kActions> action, third_action;
  one.policy().Act(observation, action);
  third.policy().Act(observation, third_action);
  EXPECT_EQ(action, third_action);
}

TEST(PpoTest, LearnsSomethingElseFromAnotherSeed) {
  Ppo one = MakePpo(SmallConfig()), other = MakePpo(SmallConfig(), 2);
  EXPECT_NE(StateAfter(one, 1), StateAfter(other, 1));
}

TEST(PpoTest, GoesOnAfterARestoreAsTheUndisturbedRunBitForBit) {
  Ppo undisturbed = MakePpo(SmallConfig());
  const std::string middle = StateAfter(undisturbed, 3);
  const std::string end = StateAfter(undisturbed, 3);
  Ppo resumed = MakePpo(SmallConfig());
  StateAfter(resumed, 1);  // its environments are somewhere else
  ASSERT_TRUE(resumed.Restore(middle).ok());
  EXPECT_EQ(resumed.iterations(), 3);
  EXPECT_EQ(resumed.samples(), 64 + 3 * 320);
  EXPECT_EQ(resumed.Save(), middle);
  EXPECT_EQ(StateAfter(resumed, 3), end);
}

TEST(PpoTest, RefusesCheckpointsOfOthersAndBrokenOnesAndStaysAsItWas) {
  Ppo ppo = MakePpo(SmallConfig());
  const std::string before = StateAfter(ppo, 1);
  PpoConfig other_config = SmallConfig();
  other_config.clip = 0.1;
  Ppo other = MakePpo(other_config), other_seed = MakePpo(SmallConfig(), 2);
  EXPECT_EQ(base::ErrorReason(ppo.Restore(other.Save())), "CHECKPOINT_DIFFERS");
  EXPECT_EQ(base::ErrorReason(ppo.Restore(other_seed.Save())), "CHECKPOINT_DIFFERS");
  for (const size_t length : {size_t{0}, size_t{20}, before.size() / 2, before.size() - 1}) {
    EXPECT_EQ(base::ErrorReason(ppo.Restore(before.substr(0, length))), "MALFORMED_CHECKPOINT")
        << length;
  }
  EXPECT_EQ(ppo.Save(), before);
}

// Does nothing until `episode`, in which it goes wrong.
std::vector<std::unique_ptr<Environment>> MakeFailing(ScriptedTask::Script script) {
  std::vector<std::unique_ptr<Environment>> environments;
  environments.push_back(std::make_unique<ScriptedTask>(std::move(script)));
  return environments;
}

TEST(PpoTest, IsAsBeforeAfterAFailedIteration) {
  PpoConfig config = SmallConfig();
  bool fail = false;
  base::RunContext context;
  bool cancel = false;
  auto ppo = Ppo::Create(MakeFailing([&](int, int step, ScriptedTask::Event& event) {
                           if (fail && step == 300) event.status = base::Internal("BROKEN", "");
                           if (cancel && step == 300) context.cancellation.Cancel();
                         }),
                         config, 1);
  ASSERT_TRUE(ppo.ok());
  const std::string before = StateAfter(*ppo, 1);
  fail = true;
  EXPECT_EQ(base::ErrorReason(ppo->Iterate().status()), "BROKEN");
  EXPECT_EQ(ppo->Save(), before);
  fail = false;
  cancel = true;
  EXPECT_EQ(ppo->Iterate(context).status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(ppo->Save(), before);
  EXPECT_TRUE(ppo->Iterate().ok());
}

TEST(PpoTest, StopsAtADeadlineAndKeepsWhatItLearned) {
  Ppo ppo = MakePpo(SmallConfig());
  const std::string before = StateAfter(ppo, 1);
  base::RunContext context;
  context.deadline = absl::Now() - absl::Seconds(1);
  EXPECT_EQ(ppo.Iterate(context).status().code(), absl::StatusCode::kDeadlineExceeded);
  EXPECT_EQ(ppo.Save(), before);
}

TEST(PpoTest, NamesTheTensorThatIsNotFinite) {
  // Rewards so far apart that a step of descent throws the critic's weights out of range.
  PpoConfig config = SmallConfig();
  config.critic.optimizer = "sgd";
  config.critic.learning_rate = 10;
  config.gradient_norm = 0;
  config.normalize_returns = false;
  config.value_high = 1e-6;
  config.value_low = -1e9;
  auto ppo = Ppo::Create(MakeFailing([](int, int step, ScriptedTask::Event& event) {
                           event.transition.reward = step % 7 == 0 ? 1e30F : -1e30F;
                         }),
                         config, 1);
  ASSERT_TRUE(ppo.ok());
  Status status;
  for (int i = 0; i < 20 && status.ok(); ++i) status = ppo->Iterate().status();
  EXPECT_EQ(base::ErrorReason(status), "NOT_FINITE");
  EXPECT_THAT(base::Message(status), HasSubstr("critic.layers.0.weight"));
}

TEST(PpoTest, StartsAtThePolicyThatDoesNothing) {
  PpoConfig config;
  Ppo ppo = MakePpo(config);
  std::array<float, LinearTask::kStates> observation = {1, -1, 0.5F, 2};
  std::array<float, LinearTask::kActions> action;
  ppo.policy().Act(observation, action);
  for (const float value : action) EXPECT_LT(std::abs(value), 0.2 * config.noise);
}

TEST(PpoTest, FollowsItsSchedules) {
  Ppo ppo = MakePpo(SmallConfig());
  const auto first = ppo.Iterate(), second = ppo.Iterate();
  ASSERT_TRUE(first.ok() && second.ok());
  // 0.3 to 0.1 within 1000 samples; 64, then 384 were behind.
  EXPECT_NEAR(first->noise, 0.3 * std::pow(1.0 / 3, 0.064), 1e-6);
  EXPECT_NEAR(second->noise, 0.3 * std::pow(1.0 / 3, 0.384), 1e-6);
  StateAfter(ppo, 3);
  EXPECT_NEAR(ppo.Iterate()->noise, 0.1, 1e-6);
}

TEST(PpoTest, EndsTheEpochsOfThePolicyBeyondTheDivergence) {
  PpoConfig config = SmallConfig();
  config.actor.learning_rate = 0.01;
  config.kl_limit = 0.01;
  const auto stopped = MakePpo(config).Iterate();
  config.kl_limit = 0;
  const auto all = MakePpo(config).Iterate();
  ASSERT_TRUE(stopped.ok() && all.ok());
  EXPECT_LT(stopped->actor_steps, all->actor_steps);
  EXPECT_EQ(all->actor_steps, 2 * 320 / 64);
  EXPECT_GT(stopped->kl, 0.01) << "what was seen when it stopped";
}

TEST(PpoTest, RefusesWhatCannotLearn) {
  EXPECT_EQ(base::ErrorReason(Ppo::Create({}, SmallConfig(), 1).status()), "NO_ENVIRONMENT");
  auto mixed = LinearTask::Make(1);
  mixed.push_back(std::move(MakeFailing([](int, int, ScriptedTask::Event&) {}).front()));
  const auto differ = Ppo::Create(std::move(mixed), SmallConfig(), 1);
  EXPECT_EQ(base::ErrorReason(differ.status()), "ENVIRONMENTS_DIFFER");
  PpoConfig config = SmallConfig();
  config.critic.hidden_layers = "16-x";
  const auto malformed = Ppo::Create(LinearTask::Make(1), config, 1);
  EXPECT_EQ(base::ErrorField(malformed.status()), "critic.hidden_layers");
}

}  // namespace
}  // namespace poise::rl
