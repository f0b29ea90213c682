#include "core/learning/nn/trainer_config.h"

#include <cmath>
#include <numbers>

namespace poise::learning {
namespace {

constexpr int64_t kMaxSteps = 1'000'000'000;
constexpr int kMaxBatch = 1'000'000;
constexpr int kMaxThreads = 1024;
constexpr double kMaxSeconds = 1e8;

}  // namespace

std::vector<base::Field> OptimizerConfig::Fields() {
  return {
      base::Text("type", &type, {"sgd", "adam", "adamw"}),
      base::Number("learning_rate", &learning_rate, 1e-12, 1e3),
      base::Number("momentum", &momentum, 0, 0.9999),
      base::Number("beta1", &beta1, 0, 0.999999),
      base::Number("beta2", &beta2, 0, 0.999999),
      base::Number("epsilon", &epsilon, 1e-16, 1),
      base::Number("weight_decay", &weight_decay, 0, 1e3),
      base::Number("warmup_steps", &warmup_steps, 0, kMaxSteps),
      base::Text("schedule", &schedule, {"constant", "step", "cosine"}),
      base::Number("decay_every", &decay_every, 1, kMaxSteps),
      base::Number("decay_factor", &decay_factor, 0, 1),
      base::Number("clip_norm", &clip_norm, 0, 1e9),
  };
}

Status OptimizerConfig::Validate() const {
  OptimizerConfig copy = *this;
  return base::CheckRanges(copy.Fields());
}

double OptimizerConfig::RateAt(int64_t step, int64_t steps) const {
  double rate = learning_rate;
  if (schedule == "step") {
    rate *= std::pow(decay_factor, static_cast<double>(step / decay_every));
  } else if (schedule == "cosine") {
    const double passed = static_cast<double>(step) / static_cast<double>(steps);
    rate *= 0.5 * (1 + std::cos(std::numbers::pi * passed));
  }
  if (step < warmup_steps) rate *= static_cast<double>(step + 1) / warmup_steps;
  return rate;
}

std::vector<base::Field> TrainerConfig::Fields() {
  return {
      base::Number("steps", &steps, 1, kMaxSteps),
      base::Number("batch_size", &batch_size, 1, kMaxBatch),
      base::Flag("with_replacement", &with_replacement),
      base::Number("validate_every", &validate_every, 1, kMaxSteps),
      base::Number("patience", &patience, 0, kMaxBatch),
      base::Number("curve_every", &curve_every, 1, kMaxSteps),
      base::Number("max_seconds", &max_seconds, 0, kMaxSeconds),
      base::Number("threads", &threads, 1, kMaxThreads),
  };
}

Status TrainerConfig::Validate() const {
  TrainerConfig copy = *this;
  return base::CheckRanges(copy.Fields());
}

}  // namespace poise::learning
