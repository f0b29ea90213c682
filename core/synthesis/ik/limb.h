#ifndef POISE_CORE_SYNTHESIS_IK_LIMB_H_
#define POISE_CORE_SYNTHESIS_IK_LIMB_H_

#include <vector>

#include "core/base/status.h"
#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/motion/kinematics/forward_kinematics.h"
#include "core/synthesis/ik/action_classes.h"

namespace poise::synthesis {

enum class Side { kRight, kLeft };

/// A leg or an arm: three joints by role, as the two rigid bones between them. Joints in between
/// (a twist joint in the forearm, a second hip joint) keep their local rotations and so ride along.
struct Limb {
  int base = -1;    ///< hip or shoulder: turns the upper bone
  int middle = -1;  ///< knee or elbow
  int end = -1;     ///< ankle or wrist: the end effector
  motion::JointRole end_role{};
};

/// Errors: kFailedPrecondition MISSING_ROLES; BAD_LIMB when a joint does not descend from the one
/// above it or a bone has no length.
StatusOr<Limb> FindLimb(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                        LimbKind kind, Side side);

/// Where a limb bends to when it is straight: the direction in which its middle joint leaves the
/// line from base to end, in the frame of the base joint.
/// Measured on the clip where the limb bends enough and always the same way, which holds for any
/// rest pose; otherwise knees bend forward and elbows backward as seen in the rest pose.
motion::Vec3 BendDirection(const motion::Clip& clip, const motion::JointRoles& roles,
                           const Limb& limb, LimbKind kind);

}  // namespace poise::synthesis

#endif  // POISE_CORE_SYNTHESIS_IK_LIMB_H_
