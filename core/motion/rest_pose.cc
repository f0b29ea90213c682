#include "core/motion/rest_pose.h"

namespace poise::motion {

using enum JointRole;

Vec3 RestVector(const Skeleton& skeleton, int from, int to) {
  Vec3 sum = Vec3::Zero();
  for (; to >= 0 && to != from; to = skeleton.parent(to)) sum += skeleton.joint(to).offset;
  return to == from ? sum : Vec3(Vec3::Zero());
}

Vec3 RestVector(const Skeleton& skeleton, const JointRoles& roles, JointRole from, JointRole to) {
  if (!roles.has(from) || !roles.has(to)) return Vec3::Zero();
  return RestVector(skeleton, roles.joint(from), roles.joint(to));
}

bool RestPoseStands(const Skeleton& skeleton, const JointRoles& roles) {
  const Vec3 spine = RestVector(skeleton, roles, kPelvis, kNeck);
  for (const auto& [from, to] :
       {std::pair(kRightHip, kRightKnee), std::pair(kLeftHip, kLeftKnee),
        std::pair(kRightKnee, kRightAnkle), std::pair(kLeftKnee, kLeftAnkle)}) {
    const Vec3 bone = RestVector(skeleton, roles, from, to);
    if (!(bone.dot(spine) < -0.5 * bone.norm() * spine.norm())) return false;
  }
  return true;
}

double LegLength(const Skeleton& skeleton, const JointRoles& roles) {
  const auto length = [&](JointRole from, JointRole to) {
    return RestVector(skeleton, roles, from, to).norm();
  };
  return (length(kRightHip, kRightKnee) + length(kRightKnee, kRightAnkle) +
          length(kLeftHip, kLeftKnee) + length(kLeftKnee, kLeftAnkle)) /
         2;
}

}  // namespace poise::motion
