#include "core/motion/clip.h"

#include <fmt/format.h>

#include <cmath>

namespace poise::motion {
namespace {

constexpr double kUnitLengthTolerance = 1e-2;
constexpr double kExactSquaredLength = 2e-12;  // within which a squared length is 1 to rounding

}  // namespace

StatusOr<Clip> Clip::Create(std::string name, SkeletonPtr skeleton, double frame_rate,
                            std::vector<Vec3> root_positions, std::vector<Quat> rotations) {
  const std::string what = fmt::format("clip '{}'", name);
  const size_t frames = root_positions.size();
  const size_t joints = skeleton->num_joints();
  if (frames == 0 || frames > kMaxFrames) {
    return base::InvalidArgument(
        "NO_FRAMES", "root_positions",
        fmt::format("{}: has {} frames, expected 1 to {}", what, frames, kMaxFrames));
  }
  if (!(frame_rate > 0 && frame_rate <= kMaxFrameRate)) {
    return base::InvalidArgument(
        "BAD_FRAME_RATE", "frame_rate",
        fmt::format("{}: frame rate {} is outside (0, {}] Hz", what, frame_rate, kMaxFrameRate));
  }
  if (rotations.size() != frames * joints) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "rotations",
        fmt::format("{}: has {} rotations, expected {} frames x {} joints = {}", what,
                    rotations.size(), frames, joints, frames * joints));
  }
  for (size_t frame = 0; frame < frames; ++frame) {
    if (!root_positions[frame].allFinite()) {
      return base::InvalidArgument(
          "NOT_FINITE", "root_positions",
          fmt::format("{}: frame {}: root position is not finite", what, frame));
    }
    for (size_t joint = 0; joint < joints; ++joint) {
      Quat& rotation = rotations[frame * joints + joint];
      // An exact unit quaternion stays bit for bit what it was.
      if (std::abs(rotation.squaredNorm() - 1) <= kExactSquaredLength) continue;
      const double length = rotation.norm();
      if (std::abs(length - 1) <= kUnitLengthTolerance) {
        rotation.coeffs() /= length;
        continue;
      }
      const std::string where = fmt::format("{}: frame {}, joint '{}'", what, frame,
                                            skeleton->joint(static_cast<int>(joint)).name);
      if (!std::isfinite(length)) {
        return base::InvalidArgument("NOT_FINITE", "rotations",
                                     fmt::format("{}: rotation is not finite", where));
      }
      return base::InvalidArgument(
          "NOT_A_ROTATION", "rotations",
          fmt::format("{}: quaternion has length {}, expected 1", where, length));
    }
  }
  return Clip(std::move(name), std::move(skeleton), frame_rate, std::move(root_positions),
              std::move(rotations));
}

}  // namespace poise::motion
