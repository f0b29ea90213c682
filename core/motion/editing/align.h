#ifndef POISE_CORE_MOTION_EDITING_ALIGN_H_
#define POISE_CORE_MOTION_EDITING_ALIGN_H_

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// Frame whose pose decides where a clip is put: MotionAug takes the second one.
inline constexpr int kAlignmentFrame = 1;

/// The clip moved on the ground and turned about the vertical so that, at `frame`, the middle
/// between the toes is above the origin, the lower toe at height 0, and the line from left to right
/// shoulder points along -X: the body faces +Z. Toes are the toe joints, or ankles without them. A
/// clip that is shorter is placed by its last frame.
/// Source: MotionAug sec. 1.3.
/// Errors: kFailedPrecondition MISSING_ROLES; kInvalidArgument BAD_FRAME (negative);
/// kFailedPrecondition NO_HEADING (shoulders above each other).
StatusOr<Clip> Align(const Clip& clip, const JointRoles& roles, int frame = kAlignmentFrame);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_ALIGN_H_
