#ifndef POISE_CORE_PUSH_RESTORATION_TURNED_BODY_H_
#define POISE_CORE_PUSH_RESTORATION_TURNED_BODY_H_

#include <vector>

#include "core/motion/clip.h"
#include "core/motion/joint_roles.h"
#include "core/push/restoration/rigid_fit.h"

namespace poise::push {

/// The 22 joints of the push models on any biped: from its roles, and where it has none of the
/// optional ones (toes, collars, head) from an average body. Ground frame, from the pelvis.
/// Preconditions: required roles present.
BodyShape ShapeOf(const motion::Clip& clip, int frame, const motion::JointRoles& roles);

/// Puts turns of the 22 joints on the skeleton of a standing body. A joint that plays no role turns
/// with the nearest one above it that does.
class TurnedBody {
 public:
  /// `standing` is of one frame, in which nothing is turned.
  TurnedBody(const motion::Clip& standing, const motion::JointRoles& roles);

  /// Local rotations of the skeleton's joints; turns are in the ground frame.
  std::vector<math::Quat> Rotations(const BodyTurns& turns) const;
  /// Where the root then is when the pelvis is at `pelvis` [m]; world frame.
  Vec3 RootPosition(const BodyTurns& turns, const Vec3& pelvis) const;

 private:
  motion::SkeletonPtr skeleton_;
  std::vector<int> body_joints_;      // of each joint, the one of the 22 that turns it
  std::vector<math::Quat> standing_;  // world rotations
  Vec3 from_pelvis_;                  // to the root, standing [m]
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_RESTORATION_TURNED_BODY_H_
