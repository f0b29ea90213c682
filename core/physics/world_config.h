#ifndef POISE_CORE_PHYSICS_WORLD_CONFIG_H_
#define POISE_CORE_PHYSICS_WORLD_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::physics {

/// Time, ground and contacts (MotionAug sec. 4.4). Defaults are the preset `recommended`.
struct WorldConfig {
  /// own: Poise's articulated dynamics and contact solver | bullet: Bullet's multibody and contacts
  std::string engine = "own";
  double rate_hz = 600;           ///< [Hz, 30 to 1e5] evaluations of the controller
  int substeps = 1;               ///< of integration and contacts per evaluation
  double gravity_mps2 = 9.8;      ///< [m/s2] downwards
  double friction = 0.9;          ///< of each body and the ground; a pair has the product
  bool self_collision = true;     ///< between bodies that are not parent and child
  int solver_iterations = 10;     ///< of the contact solver
  double contact_erp = 0.2;       ///< [0, 1] part of a penetration that a substep removes
  double warm_start = 0.85;       ///< [0, 1] part of its last impulse that a contact starts from
  bool ground = true;             ///< the plane y = 0
  bool conserve_momentum = true;  ///< own engine: only outer forces change the whole's momentum

  /// `paper`: Bullet, two substeps of 1/1200 s per evaluation. `recommended`: the own engine at 600
  /// Hz, several times as fast. Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<WorldConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_WORLD_CONFIG_H_
