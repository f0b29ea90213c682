#ifndef POISE_CORE_MOTION_KINEMATICS_SOLE_ESTIMATE_H_
#define POISE_CORE_MOTION_KINEMATICS_SOLE_ESTIMATE_H_

#include "core/motion/body_shapes.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {

/// How the feet stand, from a motion: the world's up direction in the ankle's frame, averaged over
/// the quarter of the frames in which ankle and toes of that foot are lowest (at most 64 frames are
/// looked at). Rest poses are no reliable source: some files have all bones along one axis.
/// Where the motion gives no answer (the foot never comes near level) the rest pose decides, and
/// where that is silent too the answer is at right angles to the toes.
/// Preconditions: the required roles are present.
Soles EstimateSoles(const Skeleton& skeleton, const JointRoles& roles, const WorldPoses& world);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_KINEMATICS_SOLE_ESTIMATE_H_
