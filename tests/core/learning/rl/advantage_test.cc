#include "core/learning/rl/advantage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace poise::rl {
namespace {

using testing::FloatNear;
using testing::Pointwise;

// One slot that earns 1, 2, 3 and where V is 10, 20, 30.
Batch ThreeSteps(Ending ending) {
  Batch batch(1, 3, 1, 1);
  batch.rewards = {1, 2, 3};
  batch.explored = {1, 1, 1};
  batch.endings = {Ending::kNone, Ending::kNone, ending};
  if (ending == Ending::kTruncated) batch.cut_rows = {2};
  return batch;
}

const std::vector<float> kValues = {10, 20, 30};

TEST(AdvantageTest, FollowsHandComputedNumbersUpToATermination) {
  const Advantages result =
      EstimateAdvantages(ThreeSteps(Ending::kTerminated), kValues, {}, 0.5, 0.5);
  // delta = 1 + 10 - 10, 2 + 15 - 20, 3 + 0 - 30; A = delta + 0.25 A'.
  EXPECT_THAT(result.advantages, Pointwise(FloatNear(1e-6F), {-1.4375F, -9.75F, -27.F}));
  EXPECT_THAT(result.returns, Pointwise(FloatNear(1e-5F), {8.5625F, 10.25F, 3.F}));
}

TEST(AdvantageTest, CountsTheValueBehindATruncation) {
  const std::vector<float> cut_values = {40};
  const Advantages result =
      EstimateAdvantages(ThreeSteps(Ending::kTruncated), kValues, cut_values, 0.5, 0.5);
  // The last delta is 3 + 20 - 30.
  EXPECT_THAT(result.advantages, Pointwise(FloatNear(1e-6F), {-0.1875F, -4.75F, -7.F}));
}

// Random episodes in several slots, with their values.
struct RandomBatch {
  Batch batch{5, 40, 1, 1};
  std::vector<float> values;
  std::vector<float> cut_values;
};

RandomBatch MakeRandomBatch() {
  RandomBatch result;
  base::Random random(7);
  Batch& batch = result.batch;
  for (int row = 0; row < batch.rows(); ++row) {
    batch.rewards[row] = static_cast<float>(random.Normal());
    batch.explored[row] = random.Uniform() < 0.7;
    result.values.push_back(static_cast<float>(random.Normal()));
    const double draw = random.Uniform();
    const bool last = row % batch.steps == batch.steps - 1;
    batch.endings[row] = draw < 0.05          ? Ending::kTerminated
                         : draw < 0.1 || last ? Ending::kTruncated
                                              : Ending::kNone;
    if (batch.endings[row] != Ending::kTruncated) continue;
    batch.cut_rows.push_back(row);
    result.cut_values.push_back(static_cast<float>(random.Normal()));
  }
  return result;
}

// The definition: discounted sum of all later temporal differences of the episode.
double AdvantageByDefinition(const RandomBatch& random, int row, double discount, double trace) {
  const Batch& batch = random.batch;
  double sum = 0, weight = 1;
  for (int k = row;; ++k) {
    double next = 0;
    if (batch.endings[k] == Ending::kNone) next = random.values[k + 1];
    if (batch.endings[k] == Ending::kTruncated) {
      const auto cut = std::find(batch.cut_rows.begin(), batch.cut_rows.end(), k);
      next = random.cut_values[cut - batch.cut_rows.begin()];
    }
    sum += weight * (batch.rewards[k] + discount * next - random.values[k]);
    if (batch.endings[k] != Ending::kNone) return sum;
    weight *= discount * trace;
  }
}

TEST(AdvantageTest, EqualsItsDefinitionOnRandomEpisodes) {
  const RandomBatch random = MakeRandomBatch();
  for (const double trace : {0.0, 0.9, 1.0}) {
    const Advantages result =
        EstimateAdvantages(random.batch, random.values, random.cut_values, 0.95, trace);
    for (int row = 0; row < random.batch.rows(); ++row) {
      const double expected = AdvantageByDefinition(random, row, 0.95, trace);
      ASSERT_NEAR(result.advantages[row], expected, 1e-5) << row;
      ASSERT_NEAR(result.returns[row], expected + random.values[row], 1e-5) << row;
    }
  }
}

TEST(AdvantageTest, StandardizesOverTheExploredStepsAlone) {
  const RandomBatch random = MakeRandomBatch();
  std::vector<float> advantages = random.values;
  StandardizeAdvantages(random.batch, 0, advantages);
  double count = 0, sum = 0, squares = 0;
  for (int row = 0; row < random.batch.rows(); ++row) {
    if (random.batch.explored[row] == 0) continue;
    ++count;
    sum += advantages[row];
    squares += advantages[row] * advantages[row];
  }
  EXPECT_NEAR(sum / count, 0, 1e-6);
  EXPECT_NEAR(squares / count, 1, 1e-6);

  StandardizeAdvantages(random.batch, 0.5, advantages);
  for (const float advantage : advantages) EXPECT_LE(std::abs(advantage), 0.5F);
}

TEST(AdvantageTest, StandardizesEqualAdvantagesToZero) {
  std::vector<float> advantages = {3, 3, 3};
  StandardizeAdvantages(ThreeSteps(Ending::kTerminated), 4, advantages);
  EXPECT_THAT(advantages, Pointwise(FloatNear(1e-6F), {0.F, 0.F, 0.F}));
}

}  // namespace
}  // namespace poise::rl
