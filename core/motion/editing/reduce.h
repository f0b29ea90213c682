#ifndef POISE_CORE_MOTION_EDITING_REDUCE_H_
#define POISE_CORE_MOTION_EDITING_REDUCE_H_

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// What happens to the rotation of a joint that is left out between two that are kept.
enum class ReductionMode {
  kReference,  ///< lost, as in MotionAug's program (needed to compare with the paper)
  kComposed,   ///< multiplied into the next kept joint below: kept joints keep their world rotation
};

/// The clip on the 16 joints of the required roles, in their order (MotionAug sec. 1.6); they keep
/// their names. Offsets add up over joints left out, as they lie at rest: where such a joint turns
/// (a lower back), the positions below it shift by what its bend had moved them. The pelvis becomes
/// the root with its world position and orientation in both modes. What hangs off a kept leaf
/// (toes, head, hand) becomes its end site. Errors: kFailedPrecondition MISSING_ROLES,
/// UNUSUAL_HIERARCHY (a role's joint hangs below that of a later role).
StatusOr<Clip> ReduceToRoles(const Clip& clip, const JointRoles& roles, ReductionMode mode);

/// The roles of a reduced skeleton, whatever its joints are called: joint i plays role i.
/// Errors: kInvalidArgument UNKNOWN_JOINT (not 16 joints).
StatusOr<JointRoles> ReducedRoles(const Skeleton& reduced);

/// The way back: `original` moved so that its 16 joints have the world rotations, and its pelvis
/// the positions, of `reduced` (composed from it, and edited since). Joints left out keep their own
/// rotations. Errors: as ReduceToRoles, and kInvalidArgument WRONG_SHAPE (other frames or joints).
StatusOr<Clip> ExpandFromRoles(const Clip& reduced, const Clip& original, const JointRoles& roles);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_REDUCE_H_
