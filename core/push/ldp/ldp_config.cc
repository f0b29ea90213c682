#include "core/push/ldp/ldp_config.h"

#include <fmt/format.h>

namespace poise::push::ldp {

std::vector<base::Field> BalanceConfig::Fields() {
  return {
      base::Number("self_input", &self_input, 1, 4096),
      base::Number("self_hidden", &self_hidden, 1, 4096),
      base::Number("self_scale", &self_scale, 0, 1000),
      base::Number("speed_gain", &speed_gain, 0, 1e5),
      base::Number("speed_rate", &speed_rate, 0, 1e5),
      base::Number("lean_gain", &lean_gain, 0, 1e5),
      base::Number("lean_rate", &lean_rate, 0, 1e5),
      base::Number("friction", &friction, 0, 10'000),
      base::Number("rod_hidden", &rod_hidden, 1, 4096),
      base::Number("rod_change", &rod_change, 0, 1),
      base::Number("input_unit", &input_unit, 1, 1000),
      base::Number("rod_shortest", &rod_shortest, 0.1, 3),
      base::Number("rod_longest", &rod_longest, 0.1, 3),
      base::Flag("memory_gradient", &memory_gradient),
      base::Flag("push_alone", &push_alone),
      base::Flag("wait", &wait),
  };
}

std::vector<base::Field> InteractionConfig::Fields() {
  return {
      base::Number("hidden", &hidden, 1, 4096),
      base::Number("reach_m", &reach_m, 0.1, 10),
      base::Number("moving_speed", &moving_speed, 0, 10),
      base::Number("potential", &potential, 0, 10'000),
      base::Number("potential_m", &potential_m, 0.01, 10),
      base::Number("theta_torque", &theta_torque, 0, 10'000),
      base::Number("phi_torque", &phi_torque, 0, 10'000),
      base::Number("upright", &upright, 0, 1),
      base::Flag("learned", &learned),
      base::Flag("basic", &basic),
  };
}

std::vector<base::Field> BodyConfig::Fields() {
  return {
      base::Text("parts", &parts, {"low_up", "full"}),
      base::Number("latent", &latent, 1, 1024),
      base::Number("hidden", &hidden, 1, 4096),
      base::Number("gate_hidden", &gate_hidden, 1, 4096),
      base::Number("experts", &experts, 1, 64),
      base::Number("onset_speed", &onset_speed, 0, 10),
  };
}

std::vector<base::Field> PendulumTraining::Fields() {
  std::vector<base::Field> fields = network.Fields();
  base::Append(fields, {base::Number("first_frames", &first_frames, 2, 1000),
                        base::Number("growing_share", &growing_share, 0, 1),
                        base::Number("phi_rate_weight", &phi_rate_weight, 0, 10),
                        base::Number("rod_weight", &rod_weight, 0, 100),
                        base::Number("hip_weight", &hip_weight, 0, 100)});
  return fields;
}

std::vector<base::Field> BodyTraining::Fields() {
  std::vector<base::Field> fields = network.Fields();
  base::Append(fields, {base::Number("rollout", &rollout, 1, 1000),
                        base::Number("kl_weight", &kl_weight, 0, 10),
                        base::Number("teacher_share", &teacher_share, 0, 1),
                        base::Number("ramp_share", &ramp_share, 0, 1),
                        base::Number("latent_weight", &latent_weight, 0, 100),
                        base::Number("reconstruction_weight", &reconstruction_weight, 0, 100),
                        base::Number("foot_weight", &foot_weight, 0, 100)});
  return fields;
}

std::vector<base::Field> EndToEndTraining::Fields() {
  std::vector<base::Field> fields = network.Fields();
  base::Append(fields, {base::Number("rounds", &rounds, 0, 100),
                        base::Number("joint_weight", &joint_weight, 0, 1000)});
  return fields;
}

StatusOr<LdpTraining> LdpTraining::FromPreset(std::string_view name) {
  if (name == kPreset) return LdpTraining();
  return base::InvalidArgument("UNKNOWN_PRESET", "preset",
                               fmt::format("unknown preset '{}', expected {}", name, kPreset));
}

std::vector<base::Field> LdpTraining::Fields() {
  std::vector<base::Field> fields = {base::Text("protocol", &protocol, {"A", "B", "C"}),
                                     base::Flag("pendulum", &pendulum)};
  base::Append(fields, base::Nested("balance", balance.Fields()));
  base::Append(fields, base::Nested("interaction", interaction.Fields()));
  base::Append(fields, base::Nested("body", body.Fields()));
  base::Append(fields, base::Nested("balance_training", balance_training.Fields()));
  base::Append(fields, base::Nested("interaction_training", interaction_training.Fields()));
  base::Append(fields, base::Nested("cvae_training", cvae_training.Fields()));
  base::Append(fields, base::Nested("sampler_training", sampler_training.Fields()));
  base::Append(fields, base::Nested("end_to_end", end_to_end.Fields()));
  return fields;
}

Status LdpTraining::Validate() { return base::CheckRanges(Fields()); }

}  // namespace poise::push::ldp
