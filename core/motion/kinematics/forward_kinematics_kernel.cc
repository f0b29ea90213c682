#include "core/motion/kinematics/forward_kinematics_kernel.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace poise::motion::POISE_KERNEL_ISA {

void ForwardKinematicsKernel(const ForwardKinematicsArguments& arguments) {
  using ConstQuat = Eigen::Map<const Eigen::Quaterniond>;
  using MutableQuat = Eigen::Map<Eigen::Quaterniond>;
  using ConstVec = Eigen::Map<const Eigen::Vector3d>;
  using MutableVec = Eigen::Map<Eigen::Vector3d>;

  const int joints = arguments.num_joints;
  for (int frame = 0; frame < arguments.num_frames; ++frame) {
    const double* local = arguments.local + 4L * frame * joints;
    double* positions = arguments.positions + 3L * frame * joints;
    double* rotations = arguments.rotations + 4L * frame * joints;
    MutableVec root_position(positions);
    root_position = ConstVec(arguments.root_positions + 3L * frame);
    MutableQuat root_rotation(rotations);
    root_rotation = ConstQuat(local);
    for (int joint = 1; joint < joints; ++joint) {
      const int parent = arguments.parents[joint];
      const ConstQuat world_from_parent(rotations + 4L * parent);
      MutableVec position(positions + 3L * joint);
      MutableQuat rotation(rotations + 4L * joint);
      position = ConstVec(positions + 3L * parent) +
                 world_from_parent * ConstVec(arguments.offsets + 3L * joint);
      rotation = world_from_parent * ConstQuat(local + 4L * joint);
    }
  }
}

}  // namespace poise::motion::POISE_KERNEL_ISA
