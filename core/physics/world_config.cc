#include "core/physics/world_config.h"

#include <fmt/format.h>

namespace poise::physics {

StatusOr<WorldConfig> WorldConfig::FromPreset(std::string_view preset) {
  WorldConfig config;
  if (preset == "recommended") return config;
  if (preset != "paper") {
    return base::InvalidArgument(
        "UNKNOWN_PRESET", "preset",
        fmt::format("unknown preset '{}', expected recommended or paper", preset));
  }
  config.engine = "bullet";
  config.substeps = 2;
  return config;
}

std::vector<base::Field> WorldConfig::Fields() {
  return {
      base::Text("engine", &engine, {"own", "bullet"}),
      base::Number("rate_hz", &rate_hz, 30, 1e5),
      base::Number("substeps", &substeps, 1, 100),
      base::Number("gravity_mps2", &gravity_mps2, 0, 100),
      base::Number("friction", &friction, 0, 10),
      base::Flag("self_collision", &self_collision),
      base::Number("solver_iterations", &solver_iterations, 1, 1000),
      base::Number("contact_erp", &contact_erp, 0, 1),
      base::Number("warm_start", &warm_start, 0, 1),
      base::Flag("ground", &ground),
      base::Flag("conserve_momentum", &conserve_momentum),
  };
}

}  // namespace poise::physics
