#include "core/motion/kinematics/sole_estimate.h"

#include <algorithm>

namespace poise::motion {
namespace {

using enum JointRole;

constexpr int kSampledFrames = 64;

// Where a foot without toes points: at right angles to the line between the hips.
Vec3 BodyForward(const JointRoles& roles, const WorldPoses& world, int frame) {
  const Vec3 left =
      world.position(frame, roles.joint(kLeftHip)) - world.position(frame, roles.joint(kRightHip));
  return left.cross(Vec3::UnitY());
}

std::optional<Sole> EstimateSole(const Skeleton& skeleton, const JointRoles& roles,
                                 const WorldPoses& world, JointRole ankle_role) {
  const int ankle = roles.joint(ankle_role);
  const std::optional<Vec3> toe = ToeOffset(skeleton, roles, ankle_role);
  const auto height = [&](int frame) {
    const double at_ankle = world.position(frame, ankle).y();
    return toe ? at_ankle + world.Point(frame, ankle, *toe).y() : at_ankle;
  };
  std::vector<int> frames;
  const int step = std::max(1, world.num_frames / kSampledFrames);
  for (int frame = 0; frame < world.num_frames; frame += step) frames.push_back(frame);
  const auto lowest = frames.begin() + (frames.size() + 3) / 4;
  std::nth_element(frames.begin(), lowest - 1, frames.end(),
                   [&](int a, int b) { return height(a) < height(b); });
  Vec3 up = Vec3::Zero(), forward = Vec3::Zero();
  for (auto frame = frames.begin(); frame != lowest; ++frame) {
    const Quat ankle_from_world = world.rotation(*frame, ankle).conjugate();
    up += ankle_from_world * Vec3::UnitY();
    forward += toe ? *toe : Vec3(ankle_from_world * BodyForward(roles, world, *frame));
  }
  return MakeSole(up, forward);
}

// The last resort: some direction at right angles to the toes.
Sole AnySole(const Skeleton& skeleton, const JointRoles& roles, JointRole ankle) {
  const Vec3 toe = ToeOffset(skeleton, roles, ankle).value_or(Vec3::UnitZ());
  return MakeSole(toe.unitOrthogonal(), toe).value_or(Sole{});
}

}  // namespace

Soles EstimateSoles(const Skeleton& skeleton, const JointRoles& roles, const WorldPoses& world) {
  const std::optional<Soles> rest = SolesOfRestPose(skeleton, roles);
  const auto sole = [&](JointRole ankle, std::optional<Sole> of_rest_pose) {
    if (const auto found = EstimateSole(skeleton, roles, world, ankle)) return *found;
    return of_rest_pose.value_or(AnySole(skeleton, roles, ankle));
  };
  return {.right = sole(kRightAnkle, rest ? std::optional(rest->right) : std::nullopt),
          .left = sole(kLeftAnkle, rest ? std::optional(rest->left) : std::nullopt)};
}

}  // namespace poise::motion
