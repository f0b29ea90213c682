#include "core/push/pendulum/physics_config.h"

namespace poise::push {

std::vector<base::Field> PhysicsConfig::Fields() {
  return {
      base::Number("friction", &friction, 0, 20),
      base::Number("stepping", &stepping, 0, 50),
      base::Number("lean_stiffness", &lean_stiffness, 0, 100),
      base::Number("lean_damping", &lean_damping, 0, 50),
      base::Number("body_radius_m", &body_radius_m, 0.05, 0.5),
      base::Number("contact_stiffness", &contact_stiffness, 0, 1e6),
      base::Number("reach_m", &reach_m, 0.1, 2),
      base::Number("reach_damping", &reach_damping, 0, 5000),
      base::Number("substeps", &substeps, 1, 64),
  };
}

}  // namespace poise::push
