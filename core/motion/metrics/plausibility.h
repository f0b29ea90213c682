#ifndef POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_
#define POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_

#include "core/base/json.h"
#include "core/base/status.h"
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
};

base::Json ToJson(const Plausibility& plausibility);

/// Errors: kFailedPrecondition MISSING_ROLES; CLIP_TOO_SHORT (fewer than 4 frames).
StatusOr<Plausibility> AssessPlausibility(const Clip& clip, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_PLAUSIBILITY_H_
