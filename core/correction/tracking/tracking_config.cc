#include "core/correction/tracking/tracking_config.h"

#include <fmt/format.h>

namespace poise::correction {

StatusOr<TrackingConfig> TrackingConfig::FromPreset(std::string_view preset) {
  TrackingConfig config;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.control_hz = 120;
  config.target_velocity = false;
  config.feed_forward = false;
  config.residual_factor = 1;
  config.implicit_residual = false;
  config.pelvis_limit_m = 1e3;
  config.near_floor_m = 0;
  return config;
}

std::vector<base::Field> TrackingConfig::Fields() {
  return {
      base::Number("control_hz", &control_hz, 1, 1e4),
      base::Flag("target_velocity", &target_velocity),
      base::Flag("feed_forward", &feed_forward),
      base::Number("pelvis_stiffness", &pelvis_stiffness, 0, 1e6),
      base::Number("pelvis_damping", &pelvis_damping, 0, 1e6),
      base::Number("pelvis_angular_stiffness", &pelvis_angular_stiffness, 0, 1e6),
      base::Number("pelvis_angular_damping", &pelvis_angular_damping, 0, 1e6),
      base::Number("moment_softness_m2", &moment_softness_m2, 1e-9, 1),
      base::Number("residual_factor", &residual_factor, 0, 2),
      base::Flag("implicit_residual", &implicit_residual),
      base::Number("pelvis_limit_m", &pelvis_limit_m, 0.01, 1e3),
      base::Number("near_floor_m", &near_floor_m, 0, 10),
  };
}

}  // namespace poise::correction
