#include "core/motion/kinematics/forward_kinematics.h"

#include "core/base/isa.h"
#include "core/motion/kinematics/forward_kinematics_kernel.h"

namespace poise::motion {

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double));

WorldPoses ForwardKinematics(const Clip& clip) {
  WorldPoses out;
  ForwardKinematics(clip, 0, clip.num_frames(), out);
  return out;
}

void ForwardKinematics(const Clip& clip, int first, int count, WorldPoses& out) {
  static const auto kernel =
      base::SelectKernel(isa_v2::ForwardKinematicsKernel, isa_v3::ForwardKinematicsKernel,
                         isa_v4::ForwardKinematicsKernel);
  const Skeleton& skeleton = *clip.skeleton();
  const int joints = skeleton.num_joints();
  std::vector<int> parents(joints);
  std::vector<Vec3> offsets(joints);
  for (int i = 0; i < joints; ++i) {
    parents[i] = skeleton.parent(i);
    offsets[i] = skeleton.joint(i).offset;
  }
  out.num_frames = count;
  out.num_joints = joints;
  out.positions.resize(static_cast<size_t>(count) * joints);
  out.rotations.resize(static_cast<size_t>(count) * joints);
  if (count == 0) return;
  kernel({.num_frames = count,
          .num_joints = joints,
          .parents = parents.data(),
          .offsets = offsets.data()->data(),
          .root_positions = clip.root_positions().data()[first].data(),
          .local = clip.pose(first).data()->coeffs().data(),
          .positions = out.positions.data()->data(),
          .rotations = out.rotations.data()->coeffs().data()});
}

}  // namespace poise::motion
