#ifndef POISE_CORE_CORRECTION_TRACKING_TRACKING_CONFIG_H_
#define POISE_CORE_CORRECTION_TRACKING_TRACKING_CONFIG_H_

#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::correction {

/// The controller without learning (correction spike, sec. 3). Forces and gains are those of 45 kg
/// and scale with the body. Defaults are the preset `recommended`.
struct TrackingConfig {
  double control_hz = 600;  ///< [Hz, > 0] how often targets and feed-forward are renewed
  bool target_velocity =
      true;  ///< joints' PD damps against the reference's velocity, not against 0
  /// Torques that the reference's accelerations need, the feet carrying what they touch with.
  bool feed_forward = true;
  double pelvis_stiffness = 3000;         ///< [N/m] of the pelvis, through the stance legs
  double pelvis_damping = 600;            ///< [N s/m]
  double pelvis_angular_stiffness = 300;  ///< [N m/rad]
  /// [N m s/rad] Explicit, on a light pelvis: from 20 on the load of the feet chatters at 600 Hz.
  double pelvis_angular_damping = 12;
  double moment_softness_m2 = 3e-4;  ///< [m2] see StanceLimits (stance.h)

  double residual_factor = 2;     ///< [0 to 2] on the gains of the PD-residual wrench
  bool implicit_residual = true;  ///< inside the PD's solve | false: held for a control step

  double pelvis_limit_m = 0.5;  ///< [m] farther from the reference a motion has failed
  double near_floor_m = 0.05;   ///< [m] a body whose reference comes lower may touch the ground

  /// `paper`: the zero policy of the authors' program: targets are the reference's pose, at 120 Hz,
  /// velocity 0, residual held, no limit on the pelvis. Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<TrackingConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_TRACKING_TRACKING_CONFIG_H_
