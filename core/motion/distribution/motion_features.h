#ifndef POISE_CORE_MOTION_DISTRIBUTION_MOTION_FEATURES_H_
#define POISE_CORE_MOTION_DISTRIBUTION_MOTION_FEATURES_H_

#include <Eigen/Core>

#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/distribution/dtw.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// Motions are compared at this rate [Hz] (reference sec. 1.5).
inline constexpr double kComparisonRate = 30;

/// What one motion is compared by, whatever its body, place, heading and rate: of the 16 joints of
/// the required roles, standing at the origin and facing +Z (editing/align.h).
struct MotionFeatures {
  /// What DTW compares, at kComparisonRate: rotation matrices of all joints but the root, so scaled
  /// that the distance of two frames is the norm over joints of 2 sin(angle / 2), nearly the angle
  /// between them [rad]. 135 columns. The paper takes Euler angles (reference sec. 2.10), which are
  /// far apart where two arms near a singularity are not.
  FrameFeatures rotations;
  /// The whole motion as one point, for the two-sample test: 32 poses at even shares of its time,
  /// as root position [m] and 6D rotations, and its duration [s]. The authors use the code of an
  /// autoencoder that they do not describe (reference sec. 9.3, U2); this needs no training and is
  /// the same for everyone.
  Eigen::VectorXd descriptor;
  double duration_s = 0;
  double mean_speed_mps = 0;  ///< of the joints in the world, over joints and frames
  double foot_skate_mps = 0;  ///< of metrics/plausibility.h
};

/// Errors: those of JointRoles::RequireComplete, Align, ReduceToRoles, AssessPlausibility;
/// kFailedPrecondition CLIP_TOO_SHORT.
StatusOr<MotionFeatures> DescribeMotion(const Clip& clip, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DISTRIBUTION_MOTION_FEATURES_H_
