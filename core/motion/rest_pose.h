#ifndef POISE_CORE_MOTION_REST_POSE_H_
#define POISE_CORE_MOTION_REST_POSE_H_

#include "core/motion/joint_roles.h"

/// What a skeleton's rest pose (no joint rotated) says about the body. Bone lengths are always
/// right; directions mean something only where the body stands in its rest pose.
namespace poise::motion {

/// From a joint to one below it, in the upper joint's frame [m], with the joints between unrotated;
/// zero when the second does not hang below the first.
Vec3 RestVector(const Skeleton& skeleton, int from, int to);
/// The same by roles; zero also where one of them is missing.
Vec3 RestVector(const Skeleton& skeleton, const JointRoles& roles, JointRole from, JointRole to);

/// Whether thighs and shins point away from the spine at rest. They do not where all bones lie
/// along one local axis (LAFAN, Bandai-Namco). Preconditions: required roles present.
bool RestPoseStands(const Skeleton& skeleton, const JointRoles& roles);

/// Mean length of thigh plus shin [m]. Preconditions: required roles present.
double LegLength(const Skeleton& skeleton, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_REST_POSE_H_
