#include "core/physics/humanoid_config.h"

#include <fmt/format.h>

namespace poise::physics {

StatusOr<HumanoidConfig> HumanoidConfig::FromPreset(std::string_view preset) {
  HumanoidConfig config;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.fixed_wrists = false;
  return config;
}

std::vector<base::Field> HumanoidConfig::Fields() {
  return {
      base::Number("body_mass_kg", &body_mass_kg, 5, 500),
      base::Flag("fixed_wrists", &fixed_wrists),
      base::Number("torque_limit_factor", &torque_limit_factor, 0.01, 100),
      base::Number("stiffness_factor", &stiffness_factor, 0.01, 100),
      base::Number("damping_factor", &damping_factor, 0.01, 100),
      base::Text("foot_box", &foot_box, {"reference", "heel_to_toe"}),
  };
}

}  // namespace poise::physics
