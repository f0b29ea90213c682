#ifndef POISE_CORE_MOTION_EDITING_JOINT_CORRESPONDENCE_H_
#define POISE_CORE_MOTION_EDITING_JOINT_CORRESPONDENCE_H_

#include <vector>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

/// The joint of a source skeleton that drives a joint of a target skeleton, and the constant
/// rotation between their frames.
struct DrivingJoint {
  int source = -1;  ///< -1: nothing drives it
  Quat source_from_target = Quat::Identity();
};

/// One body in a retargeting: its skeleton, roles, and optionally a motion of it.
struct RetargetBody {
  const Skeleton& skeleton;
  const JointRoles& roles;
  const Clip* motion = nullptr;
};

/// The driving joint of every joint of the target (see Retarget for the rules).
/// Shapes: (target joints). Preconditions: required roles present in both.
std::vector<DrivingJoint> FindDrivingJoints(const RetargetBody& source, const RetargetBody& target);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_JOINT_CORRESPONDENCE_H_
