#ifndef POISE_CORE_PHYSICS_HUMANOID_CONFIG_H_
#define POISE_CORE_PHYSICS_HUMANOID_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::physics {

/// The simulated character (MotionAug sec. 4.2, 4.3). Masses, inertias, gains and torque limits are
/// those of the reference's 45 kg, times body_mass_kg / 45. Defaults are the preset `recommended`.
struct HumanoidConfig {
  double body_mass_kg = 45;          ///< [kg] 5 to 500
  bool fixed_wrists = true;          ///< false: ball joints without a motor
  double torque_limit_factor = 1.5;  ///< [> 0] on DeepMimic's torque limits
  double stiffness_factor = 1;       ///< [> 0] on all joints' stiffness
  double damping_factor = 1;         ///< [> 0] on all joints' damping
  /// reference: the small box under the middle of the foot | heel_to_toe: the whole foot, as the
  /// measures of a clip have it
  std::string foot_box = "reference";

  /// `paper` leaves the wrists free and without a motor, as the authors' program does: the hands
  /// swing, and yet count in the reward. `recommended` fixes them. The foot is the reference's in
  /// both: from heel to toe 23 instead of 27 of 28 kicks complete (correction spike, sec. 3).
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<HumanoidConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_HUMANOID_CONFIG_H_
