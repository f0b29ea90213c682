#ifndef POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_
#define POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_

#include <vector>

#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/base/status.h"
#include "core/motion/body_shapes.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// How physically plausible a motion looks, by geometry alone: capsules and foot boxes on the
/// skeleton (motion/body_shapes.h) against each other and against an estimated floor.
struct Plausibility {
  double foot_skate_mps = 0;          ///< mean horizontal speed of a foot while it stands
  double penetration_mean_m = 0;      ///< mean over frames of the deepest point below the floor
  double penetration_max_m = 0;       ///< the same, worst frame
  double float_mean_m = 0;            ///< mean over frames of the lowest point's height above it
  double self_penetration_max_m = 0;  ///< worst overlap of two bodies that are no neighbours
  double acceleration_rms_mps2 = 0;   ///< over joints and frames
  double jerk_rms_mps3 = 0;

  std::vector<base::Field> Fields();
};

base::Json ToJson(const Plausibility& plausibility);

/// What counts as standing, and how the floor is found (metrics/floor_contact.h).
struct PlausibilityConfig {
  double contact_height_m = 0.025;  ///< [m, > 0] a sole lower than this above the floor stands; its
                                    ///< weight in the mean falls from 1 on the floor to 0 here
  double still_speed_mps = 0.3;     ///< [m/s, > 0] a sole point slower than this marks the floor
  double floor_band_m = 0.12;  ///< [m, > 0] still points higher than this above the lowest ones
                               ///< are a lifted foot, not the floor

  std::vector<base::Field> Fields();
};

/// Takes about 1 ms for 3 s at 120 Hz. Accelerations and jerks are central differences of the
/// joints' world positions, over three and four frames.
/// Errors: kFailedPrecondition MISSING_ROLES; CLIP_TOO_SHORT (fewer than 4 frames);
/// kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const JointRoles& roles,
                                          const PlausibilityConfig& config = {});

/// The same with given bodies and a known floor, so that a motion and its correction are held
/// against the same boxes. The shapes' joints are the clip's.
/// Errors: CLIP_TOO_SHORT, CONFIG_VALUE_OUT_OF_RANGE.
StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const BodyShapes& shapes,
                                          double floor_height_m,
                                          const PlausibilityConfig& config = {});

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_
