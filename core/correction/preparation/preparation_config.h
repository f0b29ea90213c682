#ifndef POISE_CORE_CORRECTION_PREPARATION_PREPARATION_CONFIG_H_
#define POISE_CORE_CORRECTION_PREPARATION_PREPARATION_CONFIG_H_

#include <vector>

#include "core/base/config_fields.h"

namespace poise::correction {

/// How a motion is made fit to be imitated before a body tries it: on the floor, with feet that
/// stay where they stand and limbs that do not run through each other.
struct PreparationConfig {
  bool enabled = true;

  // The body's height.
  double height_band_m = 0.12;  ///< [m, >= 0] a still foot farther from the floor stands elsewhere
  double height_cutoff_hz = 2;  ///< [Hz, > 0] zero-phase low-pass of what the body is moved by

  // When a foot stands: it begins below these and ends above twice the height or 1.6 times the
  // speed.
  double contact_height_m = 0.025;  ///< [m, > 0] of the lowest corner of its sole
  double contact_speed_mps = 0.5;   ///< [m/s, > 0] of that corner
  double shortest_s = 0.08;         ///< [s, >= 0] shorter contacts and shorter pauses do not count

  // What a standing foot does.
  double flat_angle = 0.2;  ///< [rad, >= 0] a sole tilted less stands flat; nothing is flattened
                            ///< beyond twice the angle
  double blend_s = 0.15;    ///< [s, > 0] over which a foot comes back to its own way
  double glide_cutoff_hz = 1.5;  ///< [Hz, > 0] low-pass of what the body follows gliding feet by
  double clearance_m = 0.025;  ///< [m, >= 0] that a foot is lifted more where it swings low: a body
                               ///< under gravity lags behind and would drag it
  double longest_drop_m = 0.15;  ///< [m, >= 0] the pelvis sinks at most, so that legs reach

  // Limbs.
  double overlap_m = 0.005;  ///< [m, >= 0] an overlap of two bodies that is left alone
  double widest_turn = 0.6;  ///< [rad, >= 0] a hip or shoulder turns at most to undo one

  std::vector<base::Field> Fields();
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_PREPARATION_CONFIG_H_
