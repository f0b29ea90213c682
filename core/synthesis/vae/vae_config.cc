#include "core/synthesis/vae/vae_config.h"

#include <fmt/format.h>

namespace poise::synthesis {
namespace {

constexpr int kMaxUnits = 8192;
constexpr int kMaxFrequencies = 16;
constexpr double kMaxWeight = 1e6;

VaeConfig Paper() {
  VaeConfig config;
  config.net.layers = "lstm";
  config.net.hidden = 256;
  config.net.clock = 0;
  config.root_unit = "authors";
  config.start_at_mean = false;
  config.frame_adversary_weight = 1;
  config.sequence_adversary_weight = 1;
  config.vae_optimizer = {.type = "sgd",
                          .learning_rate = 0.005,
                          .schedule = "step",
                          .decay_every = 4000,
                          .decay_factor = 0.5};
  config.discriminator_optimizer = config.vae_optimizer;
  config.trainer = {.steps = 20'000, .batch_size = 128, .with_replacement = true};
  return config;
}

}  // namespace

std::vector<base::Field> VaeNetConfig::Fields() {
  return {base::Text("layers", &layers, {"lstm", "frames"}),
          base::Number("latent", &latent, 1, kMaxUnits),
          base::Number("hidden", &hidden, 1, kMaxUnits),
          base::Number("embedding", &embedding, 1, kMaxUnits),
          base::Number("length_hidden", &length_hidden, 1, kMaxUnits),
          base::Number("clock", &clock, 0, kMaxFrequencies)};
}

VaeConfig::VaeConfig()
    : vae_optimizer{.type = "adam",
                    .learning_rate = 2e-3,
                    .warmup_steps = 50,
                    .schedule = "cosine",
                    .clip_norm = 1},
      discriminator_optimizer{.type = "adam", .learning_rate = 1e-4, .beta1 = 0.5},
      trainer{.steps = 1000, .batch_size = 8, .with_replacement = true} {}

StatusOr<VaeConfig> VaeConfig::FromPreset(std::string_view preset) {
  if (preset == "recommended") return VaeConfig();
  if (preset == "paper") return Paper();
  return base::InvalidArgument(
      "UNKNOWN_PRESET", "preset",
      fmt::format("unknown preset '{}', expected recommended or paper", preset));
}

std::vector<base::Field> VaeConfig::Fields() {
  std::vector<base::Field> fields = {
      base::Text("generator", &generator, {"vae", "gan"}),
      base::Number("frame_rate", &frame_rate, 1, 1000),
      base::Text("root_unit", &root_unit, {"standardised", "metres", "authors"}),
      base::Flag("start_at_mean", &start_at_mean),
      base::Number("smoothness_weight", &smoothness_weight, 0, kMaxWeight),
      base::Number("kl_weight", &kl_weight, 0, kMaxWeight),
      base::Number("length_weight", &length_weight, 0, kMaxWeight),
      base::Flag("adversarial", &adversarial),
      base::Number("frame_adversary_weight", &frame_adversary_weight, 0, kMaxWeight),
      base::Number("sequence_adversary_weight", &sequence_adversary_weight, 0, kMaxWeight),
  };
  base::Append(fields, base::Nested("net", net.Fields()));
  base::Append(fields, base::Nested("vae_optimizer", vae_optimizer.Fields()));
  base::Append(fields, base::Nested("discriminator_optimizer", discriminator_optimizer.Fields()));
  base::Append(fields, base::Nested("trainer", trainer.Fields()));
  return fields;
}

Status VaeConfig::Validate() const {
  VaeConfig copy = *this;
  POISE_RETURN_IF_ERROR(base::CheckRanges(copy.Fields()));
  if (net.layers == "frames" && net.clock == 0) {
    return base::InvalidArgument("CONTRADICTING_SETTINGS", "net.clock",
                                 "layers of single frames know the time by the clock alone: "
                                 "net.clock must be 1 or more");
  }
  if (generator == "gan" && !adversarial) {
    return base::InvalidArgument(
        "CONTRADICTING_SETTINGS", "adversarial",
        "a GAN learns from its adversaries alone: adversarial must be true");
  }
  return absl::OkStatus();
}

}  // namespace poise::synthesis
