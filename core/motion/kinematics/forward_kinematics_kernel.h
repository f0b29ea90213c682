#ifndef POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_KERNEL_H_
#define POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_KERNEL_H_

/// The loop of forward kinematics on bare arrays, so that it can be built per instruction set.
/// A quaternion is four doubles x y z w (Eigen's memory order), a vector three.
namespace poise::motion {

struct ForwardKinematicsArguments {
  int num_frames;
  int num_joints;
  const int* parents;            // (joints), -1 for the root
  const double* offsets;         // (joints, 3)
  const double* root_positions;  // (frames, 3)
  const double* local;           // (frames, joints, 4)
  double* positions;             // (frames, joints, 3)
  double* rotations;             // (frames, joints, 4)
};

namespace isa_v2 {
void ForwardKinematicsKernel(const ForwardKinematicsArguments& arguments);
}
namespace isa_v3 {
void ForwardKinematicsKernel(const ForwardKinematicsArguments& arguments);
}
namespace isa_v4 {
void ForwardKinematicsKernel(const ForwardKinematicsArguments& arguments);
}

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_KINEMATICS_FORWARD_KINEMATICS_KERNEL_H_
