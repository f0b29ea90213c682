#ifndef POISE_CORE_MOTION_KINEMATICS_FABRIK_H_
#define POISE_CORE_MOTION_KINEMATICS_FABRIK_H_

#include <span>

#include "core/math/rotation.h"

namespace poise::motion {

using math::Vec3;

/// When the iteration of SolveFabrik stops.
struct FabrikOptions {
  double tolerance = 1e-4;  ///< [m, > 0] distance from the chain's end to the target
  int max_iterations = 50;  ///< [>= 0] backward and forward passes
};

struct FabrikResult {
  int iterations = 0;
  double error_m = 0;  ///< distance from the chain's end to the target
};

/// Moves a chain of rigid bones so that its end meets the target while its base stays, by forward
/// and backward reaching (Aristidou and Lasenby 2011). No joint limits. A target farther than the
/// chain is long stretches the chain towards it. A straight chain that points at its target stays
/// straight: bend it first.
/// Shapes: joints (bones + 1), base first, in and out; lengths (bones) [m, > 0]
FabrikResult SolveFabrik(std::span<Vec3> joints, std::span<const double> lengths,
                         const Vec3& target, const FabrikOptions& options = {});

/// Where FABRIK's iteration on two bones ends, in closed form: the middle joint for which the end
/// is on the target, in the plane of base, target and the old middle joint, on the old one's side.
/// The target must lie in the shell |upper - lower| <= |target - base| <= upper + lower (outside it
/// the bones point along the line to the target). When the old middle lies on the line from base to
/// target the bend direction is arbitrary.
Vec3 SolveTwoBones(const Vec3& base, const Vec3& middle, double upper, double lower,
                   const Vec3& target);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_KINEMATICS_FABRIK_H_
