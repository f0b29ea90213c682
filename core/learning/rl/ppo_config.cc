#include "core/learning/rl/ppo_config.h"

#include <cmath>
#include <string>

#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"
#include "fmt/format.h"

namespace poise::rl {
namespace {

constexpr double kLargest = 1e9;
constexpr int kWidest = 65536;
constexpr int64_t kLongest = int64_t{1} << 50;

// MotionAug specification, sec. 4.11, but for the networks' step sizes, which differ.
NetworkConfig PaperNetwork(double learning_rate, double weight_decay, double output_scale) {
  NetworkConfig network;
  network.hidden_layers = "1024-512";
  network.activation = "relu";
  network.optimizer = "sgd";
  network.momentum = 0.9;
  network.learning_rate = learning_rate;
  network.weight_decay = weight_decay;
  network.output_scale = output_scale;
  return network;
}

PpoConfig Paper() {
  PpoConfig config;
  config.samples_per_update = 4096;
  config.warmup_samples = 4096;
  config.advantage_limit = 4;
  config.epochs = 1;
  config.action_bound = 1;
  config.gradient_norm = 0;
  config.kl_limit = 0;
  config.exploration = 1;
  config.exploration_end = 0.2;
  config.exploration_samples = 64'000'000;
  config.normalize_returns = false;
  config.value_low = 0;
  config.value_high = 20;
  config.observation_limit = 0;
  // The actor's last weights are uniform within +- 0.01 whatever the number of inputs, the
  // critic's are Xavier's.
  const double inputs = std::sqrt(512.0);
  config.actor = PaperNetwork(2.5e-6, 5e-4, 0.01 * inputs);
  config.critic = PaperNetwork(0.01, 0, std::sqrt(6.0 / (512.0 + 1.0)) * inputs);
  return config;
}

}  // namespace

StatusOr<std::vector<int>> NetworkConfig::HiddenSizes() const {
  std::vector<int> sizes;
  if (hidden_layers.empty()) return sizes;
  for (const auto part : absl::StrSplit(hidden_layers, '-')) {
    int size = 0;
    if (!absl::SimpleAtoi(part, &size) || size < 1 || size > kWidest) {
      return base::InvalidArgument(
          "MALFORMED_CONFIG_VALUE", "hidden_layers",
          fmt::format("'{}' is not a list of layer sizes such as 128-128", hidden_layers));
    }
    sizes.push_back(size);
  }
  return sizes;
}

std::vector<base::Field> NetworkConfig::Fields() {
  return {
      base::Text("hidden_layers", &hidden_layers),
      base::Text("activation", &activation, {"tanh", "relu"}),
      base::Number("output_scale", &output_scale, 0, kLargest),
      base::Text("optimizer", &optimizer, {"adam", "sgd"}),
      base::Number("learning_rate", &learning_rate, 1e-12, 10),
      base::Number("momentum", &momentum, 0, 0.9999),
      base::Number("weight_decay", &weight_decay, 0, 1),
  };
}

StatusOr<PpoConfig> PpoConfig::FromPreset(std::string_view preset) {
  if (preset == "recommended") return PpoConfig();
  if (preset == "paper") return Paper();
  return base::InvalidArgument("UNKNOWN_PRESET", "preset",
                               fmt::format("preset '{}' is neither recommended nor paper", preset));
}

std::vector<base::Field> PpoConfig::Fields() {
  std::vector<base::Field> fields = {
      base::Number("samples_per_update", &samples_per_update, 1, 1 << 24),
      base::Number("warmup_samples", &warmup_samples, 0, 1 << 24),
      base::Number("environments_per_task", &environments_per_task, 1, 4096),
      base::Number("threads", &threads, 0, 1024),
      base::Number("discount", &discount, 0, 0.999999),
      base::Number("trace", &trace, 0, 1),
      base::Number("advantage_limit", &advantage_limit, 0, kLargest),
      base::Number("minibatch", &minibatch, 1, 1 << 24),
      base::Number("epochs", &epochs, 1, 1000),
      base::Number("clip", &clip, 1e-6, kLargest),
      base::Number("entropy_weight", &entropy_weight, 0, kLargest),
      base::Number("action_bound", &action_bound, 0, kLargest),
      base::Number("action_bound_weight", &action_bound_weight, 0, kLargest),
      base::Number("gradient_norm", &gradient_norm, 0, kLargest),
      base::Number("kl_limit", &kl_limit, 0, kLargest),
      base::Number("noise", &noise, 1e-9, kLargest),
      base::Number("noise_end", &noise_end, 1e-9, kLargest),
      base::Number("noise_samples", &noise_samples, int64_t{0}, kLongest),
      base::Flag("learn_noise", &learn_noise),
      base::Number("exploration", &exploration, 0, 1),
      base::Number("exploration_end", &exploration_end, 0, 1),
      base::Number("exploration_samples", &exploration_samples, int64_t{0}, kLongest),
      base::Number("learning_rate_end", &learning_rate_end, 1e-9, 1),
      base::Number("learning_rate_samples", &learning_rate_samples, int64_t{0}, kLongest),
      base::Flag("normalize_returns", &normalize_returns),
      base::Number("value_low", &value_low, -kLargest, kLargest),
      base::Number("value_high", &value_high, -kLargest, kLargest),
      base::Number("observation_samples", &observation_samples, int64_t{1}, kLongest),
      base::Number("observation_deviation_min", &observation_deviation_min, 1e-9, kLargest),
      base::Number("observation_limit", &observation_limit, 0, kLargest),
  };
  base::Append(fields, base::Nested("actor", actor.Fields()));
  base::Append(fields, base::Nested("critic", critic.Fields()));
  return fields;
}

Status PpoConfig::Validate() const {
  PpoConfig copy = *this;
  POISE_RETURN_IF_ERROR(base::CheckRanges(copy.Fields()));
  POISE_RETURN_IF_ERROR(base::Annotate(actor.HiddenSizes().status(), "actor", "actor"));
  POISE_RETURN_IF_ERROR(base::Annotate(critic.HiddenSizes().status(), "critic", "critic"));
  if (!normalize_returns && value_low >= value_high) {
    return base::InvalidArgument(
        "CONFIG_VALUE_OUT_OF_RANGE", "value_low",
        fmt::format("value_low is {}, expected below value_high {}", value_low, value_high));
  }
  return absl::OkStatus();
}

}  // namespace poise::rl
