#include "core/synthesis/ik/limb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace poise::synthesis {
namespace {

using motion::JointRole;
using motion::Vec3;

constexpr double kMinBoneLength = 1e-4;  // [m]
constexpr int kFramesAtOnce = 256;       // keeps the poses of forward kinematics in the cache
// Mean sine of the bend and agreement of its directions from which a clip tells how a limb bends.
constexpr double kMinBend = 0.087;  // 5 degrees
constexpr double kMinAgreement = 0.8;

// Position of `joint` from `ancestor` when nothing is rotated, or nullopt.
std::optional<Vec3> RestOffset(const motion::Skeleton& skeleton, int ancestor, int joint) {
  Vec3 offset = Vec3::Zero();
  for (; joint > ancestor; joint = skeleton.parent(joint)) offset += skeleton.joint(joint).offset;
  if (joint != ancestor) return std::nullopt;
  return offset;
}

// Which way the body faces in the rest pose, from a left and a right joint; zero when unknown.
Vec3 RestForward(const motion::Skeleton& skeleton, const motion::JointRoles& roles) {
  for (const auto& [left, right] :
       {std::pair(JointRole::kLeftHip, JointRole::kRightHip),
        std::pair(JointRole::kLeftShoulder, JointRole::kRightShoulder)}) {
    if (!roles.has(left) || !roles.has(right)) continue;
    const Vec3 across =
        *RestOffset(skeleton, 0, roles.joint(left)) - *RestOffset(skeleton, 0, roles.joint(right));
    return across.cross(Vec3::UnitY());
  }
  return Vec3::Zero();
}

}  // namespace

StatusOr<Limb> FindLimb(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                        LimbKind kind, Side side) {
  std::array<JointRole, 3> chain =
      kind == LimbKind::kLeg
          ? std::array{JointRole::kRightHip, JointRole::kRightKnee, JointRole::kRightAnkle}
          : std::array{JointRole::kRightShoulder, JointRole::kRightElbow, JointRole::kRightWrist};
  if (side == Side::kLeft) {
    std::transform(chain.begin(), chain.end(), chain.begin(), motion::MirrorRole);
  }
  POISE_RETURN_IF_ERROR(roles.Require({chain[0], chain[1], chain[2]}));
  for (int i = 0; i < 2; ++i) {
    const int upper = roles.joint(chain[i]), lower = roles.joint(chain[i + 1]);
    const auto bone = RestOffset(skeleton, upper, lower);
    if (bone && bone->norm() >= kMinBoneLength) continue;
    return base::FailedPrecondition(
        "BAD_LIMB", "joint_roles",
        fmt::format("{} (joint '{}') {} {} (joint '{}'): not a limb to move",
                    motion::RoleName(chain[i + 1]), skeleton.joint(lower).name,
                    bone ? "coincides with" : "does not descend from", motion::RoleName(chain[i]),
                    skeleton.joint(upper).name));
  }
  return Limb{.base = roles.joint(chain[0]),
              .middle = roles.joint(chain[1]),
              .end = roles.joint(chain[2]),
              .end_role = chain[2]};
}

Vec3 BendDirection(const motion::Clip& clip, const motion::JointRoles& roles, const Limb& limb,
                   LimbKind kind) {
  Vec3 sum = Vec3::Zero();
  double total = 0;
  motion::WorldPoses poses;
  for (int first = 0; first < clip.num_frames(); first += kFramesAtOnce) {
    const int count = std::min(kFramesAtOnce, clip.num_frames() - first);
    motion::ForwardKinematics(clip, first, count, poses);
    for (int frame = 0; frame < count; ++frame) {
      const Vec3 upper = poses.position(frame, limb.middle) - poses.position(frame, limb.base);
      const Vec3 axis =
          (poses.position(frame, limb.end) - poses.position(frame, limb.base)).normalized();
      const Vec3 bend = (upper - axis * axis.dot(upper)) / upper.norm();
      sum += poses.rotation(frame, limb.base).conjugate() * bend;
      total += bend.norm();
    }
  }
  if (total >= kMinBend * clip.num_frames() && sum.norm() >= kMinAgreement * total) {
    return sum.normalized();
  }
  const Vec3 forward = RestForward(*clip.skeleton(), roles);
  const Vec3 bone = RestOffset(*clip.skeleton(), limb.base, limb.middle)->normalized();
  const Vec3 anatomical = kind == LimbKind::kLeg ? forward : Vec3(-forward);
  const Vec3 across = anatomical - bone * bone.dot(anatomical);
  return across.norm() > 1e-6 ? Vec3(across.normalized()) : bone.unitOrthogonal();
}

}  // namespace poise::synthesis
