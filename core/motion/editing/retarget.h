#ifndef POISE_CORE_MOTION_EDITING_RETARGET_H_
#define POISE_CORE_MOTION_EDITING_RETARGET_H_

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

struct RetargetOptions {
  /// Any motion of the target body. Needed only where its rest pose does not stand (LAFAN,
  /// Bandai-Namco): it tells how the joints are turned about their bones. Without it such joints
  /// come out where they should, turned about their bones by some constant.
  const Clip* target_reference = nullptr;
};

/// The motion done by another body: its proportions, this motion.
///   - Joints correspond by role, others by equal name (in any case). Limb bones of the target
///   point
///     in the world where those of the source point, frame by frame; pelvis and chest follow the
///     line of the hips or shoulders, then the spine.
///   - Between the frames of two joints stands one constant rotation, found from rest poses that
///     stand, else from the average pose of the clip; then turned so that bones agree.
///   - The path of the pelvis is scaled by the ratio of leg lengths; then the whole body is lifted
///   or
///     lowered by one constant so that the feet are as high above the floor as the source's,
///     scaled (median over frames of the lower sole).
///   - Target joints without counterpart stay at rest; source joints without one act through those
///     below them (world rotations are copied).
/// The clip keeps its name and rate. To the same skeleton it is the identity.
/// Errors: kFailedPrecondition MISSING_ROLES (field "roles" of the source or "target_roles");
/// kFailedPrecondition DEGENERATE_SKELETON (legs of no length).
StatusOr<Clip> Retarget(const Clip& clip, const JointRoles& roles, SkeletonPtr target,
                        const JointRoles& target_roles, const RetargetOptions& options = {});

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_RETARGET_H_
