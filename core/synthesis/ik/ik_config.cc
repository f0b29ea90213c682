#include "core/synthesis/ik/ik_config.h"

#include <fmt/format.h>

#include <numbers>

namespace poise::synthesis {

StatusOr<IkConfig> IkConfig::FromPreset(std::string_view preset, const ActionClass& action_class) {
  IkConfig config;
  config.radius_low = action_class.radius_low;
  config.radius_high = action_class.radius_high;
  config.height_low = action_class.height_low;
  config.height_high = action_class.height_high;
  config.angle = action_class.angle;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.keyframe_rule = "paper";
  config.propagation = "ramp";
  config.profile = "linear";
  config.spread = "position";
  config.bend_plane = "kept";
  return config;
}

std::vector<base::Field> IkConfig::Fields() {
  return {
      base::Number("radius_low", &radius_low, 0, 10),
      base::Number("radius_high", &radius_high, 0, 10),
      base::Number("height_low", &height_low, 0, 10),
      base::Number("height_high", &height_high, 0, 10),
      base::Number("angle", &angle, 0, std::numbers::pi),
      base::Number("floor_m", &floor_m, -1e4, 1e4),
      base::Text("keyframe_rule", &keyframe_rule, {"reference", "paper"}),
      base::Number("keyframe", &keyframe, -1, 10'000'000),
      base::Text("end_effector", &end_effector,
                 {"auto", "left_ankle", "right_ankle", "left_wrist", "right_wrist"}),
      base::Text("propagation", &propagation, {"window", "ramp"}),
      base::Number("window_s", &window_s, 1e-3, 1e3),
      base::Text("profile", &profile, {"minimum_jerk", "linear"}),
      base::Text("spread", &spread, {"limb", "position"}),
      base::Text("solver", &solver, {"exact", "iterative"}),
      base::Number("tolerance", &tolerance, 1e-9, 1e-1),
      base::Number("max_iterations", &max_iterations, 1, 10'000),
      base::Text("bend_plane", &bend_plane, {"swung", "kept"}),
      base::Flag("hinge_limit", &hinge_limit),
      base::Number("max_flexion", &max_flexion, 0.1, std::numbers::pi),
  };
}

Status IkConfig::Validate() const {
  const auto ordered = [](const char* low_name, double low, const char* high_name,
                          double high) -> Status {
    if (low <= high) return absl::OkStatus();
    return base::InvalidArgument(
        "CONFIG_VALUE_OUT_OF_RANGE", fmt::format("ik.{}", low_name),
        fmt::format("'ik.{}' is {}, above 'ik.{}' = {}", low_name, low, high_name, high));
  };
  POISE_RETURN_IF_ERROR(ordered("radius_low", radius_low, "radius_high", radius_high));
  return ordered("height_low", height_low, "height_high", height_high);
}

}  // namespace poise::synthesis
