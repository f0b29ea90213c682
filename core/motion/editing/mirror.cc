#include "core/motion/editing/mirror.h"

#include "core/motion/editing/mirror_frames.h"
#include "core/motion/joint_pairs.h"

namespace poise::motion {

StatusOr<Clip> Mirror(const Clip& clip, const JointRoles& roles) {
  POISE_ASSIGN_OR_RETURN(const std::vector<int> partners, FindJointPairs(*clip.skeleton(), roles));
  POISE_ASSIGN_OR_RETURN(const std::vector<math::Mat3> frames,
                         FindMirrorFrames(clip, roles, partners));
  // With world rotations G' = S G_partner M follows for the local ones, since S S = 1:
  //   R' = M_parent^T R_partner M,  root: R' = S R M.
  // An improper M is -1 times a rotation Q; the signs cancel in pairs. Q_partner = -Q^-1, so that
  // mirroring twice does not flip the sign of a quaternion.
  const int joints = clip.num_joints();
  const Quat world_mirror(0, 1, 0, 0);  // -diag(-1, 1, 1)
  std::vector<Quat> turns(joints);
  for (int j = 0; j < joints; ++j) {
    if (partners[j] < j) {
      turns[j].coeffs() = -turns[partners[j]].conjugate().coeffs();
    } else {
      turns[j] = Quat(math::Mat3(-frames[j]));
    }
  }
  std::vector<Vec3> positions(clip.num_frames());
  std::vector<Quat> rotations;
  rotations.reserve(clip.rotations().size());
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    const Vec3& position = clip.root_position(frame);
    positions[frame] = Vec3(-position.x(), position.y(), position.z());
    for (int j = 0; j < joints; ++j) {
      const int parent = clip.skeleton()->parent(j);
      const Quat& before = parent < 0 ? world_mirror : turns[parent];
      rotations.push_back(before.conjugate() * clip.rotation(frame, partners[j]) * turns[j]);
    }
  }
  return Clip::Create(clip.name(), clip.skeleton(), clip.frame_rate(), std::move(positions),
                      std::move(rotations));
}

}  // namespace poise::motion
