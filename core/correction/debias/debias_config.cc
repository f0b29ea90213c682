#include "core/correction/debias/debias_config.h"

#include <fmt/format.h>

namespace poise::correction {
namespace {

DebiasConfig Paper() {
  DebiasConfig config;
  config.input = {.moments = 1, .spacing_s = 1 / 120.0};
  config.hidden = 512;
  config.layers = 4;
  config.dropout = 0.1;
  config.l2_weight = 0;
  config.l1_weight = 1e-4;
  config.mirror = false;
  config.cutoff_hz = 0;
  config.hold.enabled = false;
  config.correction = "paper";
  config.optimizer = {.type = "adam",
                      .learning_rate = 0.01,
                      .weight_decay = 1e-4,
                      .schedule = "step",
                      .decay_every = 500,
                      .decay_factor = 0.1};
  config.trainer = {.steps = 2000, .batch_size = 4096, .with_replacement = true};
  return config;
}

}  // namespace

std::vector<base::Field> DebiasInput::Fields() {
  return {base::Number("moments", &moments, 0, 100),
          base::Number("spacing_s", &spacing_s, 1e-4, 10)};
}

std::vector<base::Field> FootHold::Fields() {
  return {base::Flag("enabled", &enabled), base::Number("low_m", &low_m, 0, 10),
          base::Number("high_m", &high_m, 0, 10), base::Flag("root", &root)};
}

DebiasConfig::DebiasConfig()
    : optimizer{.type = "adam", .learning_rate = 5e-3, .warmup_steps = 20, .schedule = "cosine"},
      trainer{.steps = 400, .batch_size = 512, .with_replacement = true} {}

StatusOr<DebiasConfig> DebiasConfig::FromPreset(std::string_view preset) {
  if (preset == "recommended") return DebiasConfig();
  if (preset == "paper") return Paper();
  return base::InvalidArgument(
      "UNKNOWN_PRESET", "preset",
      fmt::format("unknown preset '{}', expected recommended or paper", preset));
}

std::vector<base::Field> DebiasConfig::Fields() {
  std::vector<base::Field> fields = base::Nested("input", input.Fields());
  base::Append(fields,
               {base::Number("hidden", &hidden, 1, 8192), base::Number("layers", &layers, 0, 16),
                base::Number("dropout", &dropout, 0, 0.999),
                base::Number("l2_weight", &l2_weight, 0, 1e6), base::Flag("choose_l2", &choose_l2),
                base::Flag("mirror", &mirror), base::Number("l1_weight", &l1_weight, 0, 1e6),
                base::Number("cutoff_hz", &cutoff_hz, 0, 1000),
                base::Text("effort", &effort, {"instant", "fast"}),
                base::Text("correction", &correction, {"recommended", "paper"})});
  base::Append(fields, base::Nested("hold", hold.Fields()));
  base::Append(fields, base::Nested("optimizer", optimizer.Fields()));
  base::Append(fields, base::Nested("trainer", trainer.Fields()));
  return fields;
}

Status DebiasConfig::Validate() const {
  DebiasConfig copy = *this;
  POISE_RETURN_IF_ERROR(base::CheckRanges(copy.Fields()));
  if (layers == 0 && (dropout > 0 || l1_weight > 0 || l2_weight == 0)) {
    return base::InvalidArgument("CONTRADICTING_SETTINGS", "layers",
                                 "a linear map is found in closed form: layers 0 needs an "
                                 "l2_weight above 0, and no dropout and no l1_weight");
  }
  return absl::OkStatus();
}

}  // namespace poise::correction
