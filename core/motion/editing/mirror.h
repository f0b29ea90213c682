#ifndef POISE_CORE_MOTION_EDITING_MIRROR_H_
#define POISE_CORE_MOTION_EDITING_MIRROR_H_

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// The motion as a mirror in the world's plane x = 0 shows it, done by the same body: left and
/// right change places (MotionAug sec. 1.4; an aligned clip faces along that plane).
///
/// World positions become the mirror image, joint for joint, up to the difference in length between
/// left and right bones. Where the rest pose is symmetric this is MotionAug's rule (swap partners,
/// negate two components of each quaternion). Where it is not (limbs with mirrored local axes, or
/// a rest pose caught from a real stance), each joint gets its own map between its frame and its
/// partner's, found from the bones and, for the turn about a bone that bones cannot tell, from the
/// average pose of this clip.
/// Mirroring twice gives the clip back: bit for bit under MotionAug's rule, else to rounding.
/// Errors: kFailedPrecondition MISSING_ROLES, ASYMMETRIC_SKELETON (partners hang off joints that
/// are no partners, or bones differ by more than 15 % and 1 cm between the sides).
StatusOr<Clip> Mirror(const Clip& clip, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_MIRROR_H_
