#include "core/learning/rl/rollout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/core/learning/rl/linear_task.h"
#include "tests/core/learning/rl/scripted_task.h"

namespace poise::rl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kGain = 1e-3F;

// A linear policy whose mean actions are the sum of its observations times the gain.
Policy SumPolicy(int observations, int actions) {
  ObservationScale scale{.mean = std::vector<float>(observations),
                         .inverse_deviation = std::vector<float>(observations, 1)};
  std::vector<LayerWeights> layers = {
      {.weight = kGain * Eigen::MatrixXf::Ones(actions, observations),
       .bias = Eigen::VectorXf::Zero(actions)}};
  return Policy(*PolicyNetwork::Create(scale, layers, Activation::kTanh));
}

StatusOr<Batch> Collect(ScriptedTask::Script script, int steps,
                        const base::RunContext& context = {}) {
  std::vector<std::unique_ptr<Environment>> environments;
  environments.push_back(std::make_unique<ScriptedTask>(std::move(script)));
  RolloutCollector collector(std::move(environments), 1);
  base::ThreadPool pool(1);
  return collector.Collect(SumPolicy(2, 1), {.deviations = {0.5F}}, steps, 1, pool, context);
}

TEST(RolloutTest, LaysEpisodesOneAfterAnotherAndKeepsWhatFollowsACut) {
  // The first episode fails at step 2, the second runs out of time at step 3, the third is cut.
  const auto batch = Collect(
      [](int episode, int step, ScriptedTask::Event& event) {
        event.transition.terminated = episode == 1 && step == 2;
        event.transition.truncated = episode == 2 && step == 3;
      },
      7);
  ASSERT_TRUE(batch.ok()) << batch.status();
  EXPECT_THAT(batch->observations, ElementsAre(1, 0, 1, 1, 2, 0, 2, 1, 2, 2, 3, 0, 3, 1));
  EXPECT_THAT(batch->rewards, ElementsAre(1, 2, 1, 2, 3, 1, 2));
  using enum Ending;
  EXPECT_THAT(batch->endings,
              ElementsAre(kNone, kTerminated, kNone, kNone, kTruncated, kNone, kTruncated));
  EXPECT_THAT(batch->cut_rows, ElementsAre(4, 6));
  EXPECT_THAT(batch->cut_observations, ElementsAre(2, 3, 3, 2));
  EXPECT_EQ(batch->episodes, 2);
  EXPECT_EQ(batch->terminated, 1);
  EXPECT_EQ(batch->return_sum, 1 + 2 + 1 + 2 + 3);
  EXPECT_EQ(batch->episode_steps, 5);
}

TEST(RolloutTest, CountsAnEpisodeThatEndsWithTheBatchAndNotOneThatIsCut) {
  const auto batch = Collect(
      [](int, int step, ScriptedTask::Event& event) { event.transition.terminated = step == 2; },
      4);
  ASSERT_TRUE(batch.ok());
  EXPECT_EQ(batch->episodes, 2);
  EXPECT_THAT(batch->cut_rows, ElementsAre());
}

RolloutCollector LinearCollector(int environments, int per_task) {
  return RolloutCollector(LinearTask::Make(environments), per_task);
}

TEST(RolloutTest, DrawsActionsAroundTheMeanAndKnowsTheirProbability) {
  RolloutCollector collector = LinearCollector(4, 4);
  base::ThreadPool pool(1);
  const Exploration exploration{.deviations = {0.5F, 0.1F}, .share = 0.75};
  const auto batch =
      collector.Collect(SumPolicy(4, 2), exploration, 1000, 3, pool, base::RunContext());
  ASSERT_TRUE(batch.ok());
  double squares[2] = {}, explored = 0;
  for (int row = 0; row < batch->rows(); ++row) {
    double mean = 0, log_prob = 0;
    for (int i = 0; i < 4; ++i) mean += kGain * batch->observations[4 * row + i];
    for (int i = 0; i < 2; ++i) {
      const double deviation = exploration.deviations[i];
      const double score = (batch->actions[2 * row + i] - mean) / deviation;
      if (batch->explored[row] == 0) {
        ASSERT_NEAR(score, 0, 1e-5);
      }
      squares[i] += score * score;
      log_prob -= 0.5 * score * score + std::log(deviation * std::sqrt(2 * M_PI));
    }
    ASSERT_NEAR(batch->log_probs[row], log_prob, 1e-4);
    explored += batch->explored[row];
  }
  EXPECT_NEAR(explored / batch->rows(), 0.75, 0.03);
  for (const double sum : squares) EXPECT_NEAR(sum / explored, 1, 0.06);
}

TEST(RolloutTest, FillsTheSameBatchWhateverTheThreadsAndTasks) {
  const Exploration exploration{.deviations = {0.5F, 0.1F}};
  std::vector<Batch> batches;
  for (const auto& [threads, per_task] : {std::pair(1, 7), std::pair(2, 3), std::pair(3, 1)}) {
    RolloutCollector collector = LinearCollector(7, per_task);
    base::ThreadPool pool(threads);
    auto batch = collector.Collect(SumPolicy(4, 2), exploration, 90, 3, pool, base::RunContext());
    ASSERT_TRUE(batch.ok());
    batches.push_back(*std::move(batch));
  }
  for (const Batch& other : batches) {
    EXPECT_EQ(other.observations, batches[0].observations);
    EXPECT_EQ(other.actions, batches[0].actions);
    EXPECT_EQ(other.rewards, batches[0].rewards);
    EXPECT_EQ(other.log_probs, batches[0].log_probs);
    EXPECT_EQ(other.cut_rows, batches[0].cut_rows);
    EXPECT_EQ(other.cut_observations, batches[0].cut_observations);
  }
  // Environments do not repeat each other.
  const auto& first = batches[0].observations;
  EXPECT_NE(first[0], first[static_cast<size_t>(90) * 4]);
}

TEST(RolloutTest, NamesWhatIsNotFinite) {
  const auto reward = Collect(
      [](int, int step, ScriptedTask::Event& event) {
        if (step == 3) event.transition.reward = std::numeric_limits<float>::quiet_NaN();
      },
      5);
  EXPECT_EQ(base::ErrorReason(reward.status()), "NOT_FINITE");
  EXPECT_THAT(base::Message(reward.status()), HasSubstr("reward[0] of environment 0 is nan"));
  const auto observation = Collect(
      [](int, int, ScriptedTask::Event& event) {
        event.observation = std::numeric_limits<float>::infinity();
      },
      5);
  EXPECT_THAT(base::Message(observation.status()), HasSubstr("observation[1] of environment 0"));
}

TEST(RolloutTest, ReturnsTheErrorOfAnEnvironment) {
  const auto batch = Collect(
      [](int, int step, ScriptedTask::Event& event) {
        if (step == 2) event.status = base::Internal("BROKEN", "a spring");
      },
      5);
  EXPECT_EQ(base::ErrorReason(batch.status()), "BROKEN");
}

TEST(RolloutTest, StopsAtCancellationAndDeadline) {
  base::RunContext context;
  const auto cancelled = Collect(
      [&context](int, int step, ScriptedTask::Event&) {
        if (step == 3) context.cancellation.Cancel();
        ASSERT_LT(step, 4);
      },
      1000, context);
  EXPECT_EQ(cancelled.status().code(), absl::StatusCode::kCancelled);

  base::RunContext late;
  late.deadline = absl::Now() - absl::Seconds(1);
  const auto stopped = Collect([](int, int, ScriptedTask::Event&) {}, 1000, late);
  EXPECT_EQ(stopped.status().code(), absl::StatusCode::kDeadlineExceeded);
}

}  // namespace
}  // namespace poise::rl
