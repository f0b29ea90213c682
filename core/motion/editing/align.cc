#include "core/motion/editing/align.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {

using enum JointRole;

StatusOr<Clip> Align(const Clip& clip, const JointRoles& roles, int frame) {
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  if (frame < 0) {
    return base::InvalidArgument(
        "BAD_FRAME", "frame",
        fmt::format("clip '{}': cannot align by frame {}", clip.name(), frame));
  }
  WorldPoses world;
  ForwardKinematics(clip, std::min(frame, clip.num_frames() - 1), 1, world);
  const auto at = [&](JointRole role) { return world.position(0, roles.joint(role)); };
  const bool has_toes = roles.has(kLeftToe) && roles.has(kRightToe);
  const Vec3 left = at(has_toes ? kLeftToe : kLeftAnkle);
  const Vec3 right = at(has_toes ? kRightToe : kRightAnkle);
  Vec3 middle = (left + right) / 2;
  middle.y() = std::min(left.y(), right.y());

  Vec3 across = at(kRightShoulder) - at(kLeftShoulder);
  across.y() = 0;
  if (across.norm() < 1e-3) {
    return base::FailedPrecondition(
        "NO_HEADING", "clip",
        fmt::format(
            "clip '{}': the shoulders of frame {} lie above each other, so it faces nowhere",
            clip.name(), std::min(frame, clip.num_frames() - 1)));
  }
  // About +Y the angle from direction a to direction b in the ground plane is that of (z, x).
  const double angle = std::atan2(-1, 0) - std::atan2(across.x(), across.z());
  const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  Clip aligned = clip;
  for (int f = 0; f < clip.num_frames(); ++f) {
    aligned.root_position(f) = turn * (clip.root_position(f) - middle);
    aligned.rotation(f, 0) = (turn * clip.rotation(f, 0)).normalized();
  }
  return aligned;
}

}  // namespace poise::motion
