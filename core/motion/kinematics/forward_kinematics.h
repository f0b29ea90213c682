#ifndef POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_H_
#define POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_H_

#include <span>
#include <vector>

#include "core/motion/clip.h"

namespace poise::motion {

/// Where every joint is and how it is turned, in the world.
/// Shapes: positions (frames, joints, 3) [m]; rotations (frames, joints), world from joint
struct WorldPoses {
  int num_frames = 0;
  int num_joints = 0;
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;

  const Vec3& position(int frame, int joint) const { return positions[Index(frame, joint)]; }
  const Quat& rotation(int frame, int joint) const { return rotations[Index(frame, joint)]; }
  /// World position of a point given in a joint's frame (an end site, a capsule's centre).
  Vec3 Point(int frame, int joint, const Vec3& local) const {
    return position(frame, joint) + rotation(frame, joint) * local;
  }

 private:
  size_t Index(int frame, int joint) const {
    return static_cast<size_t>(frame) * num_joints + joint;
  }
};

/// Walks the tree of every frame: rotation = parent's rotation * local rotation, position =
/// parent's position + parent's rotation * offset.
WorldPoses ForwardKinematics(const Clip& clip);

/// The same for frames [first, first + count), into memory of the caller that is reused.
void ForwardKinematics(const Clip& clip, int first, int count, WorldPoses& out);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_H_
