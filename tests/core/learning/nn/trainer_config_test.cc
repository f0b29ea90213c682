#include "core/learning/nn/trainer_config.h"

#include <gtest/gtest.h>

namespace poise::learning {
namespace {

TEST(OptimizerConfigTest, StepScheduleHalvesTheRateEverySoManySteps) {
  const OptimizerConfig config{.learning_rate = 0.005, .schedule = "step", .decay_every = 4000};
  EXPECT_DOUBLE_EQ(config.RateAt(3999, 20000), 0.005);
  EXPECT_DOUBLE_EQ(config.RateAt(4000, 20000), 0.0025);
  EXPECT_DOUBLE_EQ(config.RateAt(19999, 20000), 0.005 / 16);
}

TEST(OptimizerConfigTest, CosineScheduleIsHalfTheRateInTheMiddle) {
  const OptimizerConfig config{.learning_rate = 0.1, .schedule = "cosine"};
  EXPECT_DOUBLE_EQ(config.RateAt(0, 1000), 0.1);
  EXPECT_NEAR(config.RateAt(500, 1000), 0.05, 1e-15);
  EXPECT_LT(config.RateAt(999, 1000), 1e-5);
}

TEST(OptimizerConfigTest, WarmUpGrowsLinearlyToTheRate) {
  const OptimizerConfig config{.learning_rate = 1, .warmup_steps = 4};
  EXPECT_DOUBLE_EQ(config.RateAt(0, 100), 0.25);
  EXPECT_DOUBLE_EQ(config.RateAt(2, 100), 0.75);
  EXPECT_DOUBLE_EQ(config.RateAt(4, 100), 1);
}

TEST(TrainerConfigTest, ValuesOutOfRangeAreNamed) {
  const TrainerConfig config{.batch_size = 0};
  EXPECT_EQ(base::ErrorField(config.Validate()), "batch_size");
  const OptimizerConfig optimizer{.type = "newton"};
  EXPECT_EQ(base::ErrorField(optimizer.Validate()), "type");
}

}  // namespace
}  // namespace poise::learning
