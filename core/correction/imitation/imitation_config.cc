#include "core/correction/imitation/imitation_config.h"

#include <fmt/format.h>

namespace poise::correction {

StatusOr<ImitationConfig> ImitationConfig::FromPreset(std::string_view preset) {
  ImitationConfig config;
  POISE_ASSIGN_OR_RETURN(config.ppo, rl::PpoConfig::FromPreset(preset));
  if (preset == "recommended") return config;
  config.control_hz = 120;
  config.residual = "pd";
  config.residual_term = true;
  config.force_weight = 0;
  config.torque_weight = 0;
  config.start_share = 0;
  config.patience = 0;
  return config;
}

std::vector<base::Field> ImitationConfig::Fields() {
  std::vector<base::Field> fields = {
      base::Number("control_hz", &control_hz, 1, 1e4),
      base::Text("residual", &residual, {"none", "pd", "pd_scaled", "rfc", "pd_rfc"}),
      base::Number("joint_scale", &joint_scale, 1e-6, 100),
      base::Number("force_scale", &force_scale, 1e-6, 1e6),
      base::Number("torque_scale", &torque_scale, 1e-6, 1e6),
      base::Number("residual_scale", &residual_scale, 1e-6, 1e3),
      base::Number("learned_scale", &learned_scale, 1e-6, 1e6),
      base::Number("look_ahead_s", &look_ahead_s, 0, 10),
      base::Flag("residual_term", &residual_term),
      base::Number("force_weight", &force_weight, 0, 100),
      base::Number("torque_weight", &torque_weight, 0, 100),
      base::Number("start_share", &start_share, 0, 1),
      base::Number("max_samples", &max_samples, int64_t{1}, int64_t{1'000'000'000'000}),
      base::Number("max_seconds", &max_seconds, 1e-3, 1e9),
      base::Number("evaluate_every", &evaluate_every, 1, 1'000'000),
      base::Number("held_out", &held_out, 1, 1000),
      base::Number("patience", &patience, 0, 1'000'000),
      base::Number("least_gain", &least_gain, 0, 1),
      base::Number("environments", &environments, 1, 1000),
  };
  base::Append(fields, base::Nested("ppo", ppo.Fields()));
  return fields;
}

Status ImitationConfig::Validate() const {
  ImitationConfig checked = *this;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  return base::Annotate(ppo.Validate(), "imitation", "ppo");
}

}  // namespace poise::correction
