#ifndef POISE_CORE_PUSH_PENDULUM_PHYSICS_CONFIG_H_
#define POISE_CORE_PUSH_PENDULUM_PHYSICS_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::push {

/// How pendulums keep their balance and touch each other, without learning. Each force is a rate
/// per mass, so that one setting serves light and heavy people. Lean is measured from the lean in
/// which a person stands. Chosen by hand, so that people come to rest upright and a strong push
/// goes through a line of ten; fits to the training takes end in pendulums that fall
/// (docs/push.md).
struct PhysicsConfig {
  double friction = 1;          ///< [1/s, 0 to 20] the floor brakes the cart: force / mass / speed
  double stepping = 0;          ///< [m/s^2, 0 to 50] the feet follow the lean: force / mass / rad
  double lean_stiffness = 20;   ///< [1/s^2, 0 to 100] uprights the rod: torque / (mass rod^2) / rad
  double lean_damping = 9;      ///< [1/s, 0 to 50] torque / (mass rod^2) / (rad/s)
  double body_radius_m = 0.15;  ///< [m, 0.05 to 0.5] of the trunk, as an upright capsule
  double contact_stiffness = 6e4;  ///< [N/m, 0 to 1e6] of two trunks pressed into each other
  double reach_m = 0.6;            ///< [m, 0.1 to 2] distance of hips from which arms hold off
  double reach_damping = 20;       ///< [N s/m, 0 to 5000] force / speed at which two people near
  int substeps = 4;                ///< [1 to 64] integration steps in one frame

  std::vector<base::Field> Fields();
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PENDULUM_PHYSICS_CONFIG_H_
