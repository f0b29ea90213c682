#ifndef POISE_CORE_MOTION_EDITING_MIRROR_FRAMES_H_
#define POISE_CORE_MOTION_EDITING_MIRROR_FRAMES_H_

#include <span>
#include <vector>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// How the frame of each joint looks in the mirror: maps[j] is the reflection M_j with which a bone
/// o of joint j appears as the bone M_j o of its partner. M_j is improper (determinant -1) and
/// M_partner(j) = M_j^T. For a symmetric rest pose all of them are one reflection.
/// Shapes: partners (joints); result (joints)
/// Errors: kFailedPrecondition ASYMMETRIC_SKELETON, naming the bone.
StatusOr<std::vector<math::Mat3>> FindMirrorFrames(const Clip& clip, const JointRoles& roles,
                                                   std::span<const int> partners);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_MIRROR_FRAMES_H_
