#ifndef POISE_CORE_MOTION_JOINT_PAIRS_H_
#define POISE_CORE_MOTION_JOINT_PAIRS_H_

#include <vector>

#include "core/motion/joint_roles.h"

namespace poise::motion {

/// For each joint the one on the other side; a joint of the trunk is its own partner. Joints with a
/// role are paired by role, the others by name: left/right anywhere, or l/r as a prefix or suffix
/// ("Thumb_L", "lhand"), in any case.
/// Shapes: (joints); partners[partners[j]] == j, and partners hang off partners.
/// Errors: kFailedPrecondition MISSING_ROLES, ASYMMETRIC_SKELETON (partners hang off joints that
/// are no partners).
StatusOr<std::vector<int>> FindJointPairs(const Skeleton& skeleton, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_JOINT_PAIRS_H_
