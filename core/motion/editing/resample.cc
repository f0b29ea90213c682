#include "core/motion/editing/resample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/math/slerp.h"

namespace poise::motion {
namespace {

Status CheckFrameCount(const Clip& clip, double num_frames) {
  if (num_frames <= Clip::kMaxFrames) return absl::OkStatus();
  return base::InvalidArgument(
      "TOO_MANY_FRAMES", "num_frames",
      fmt::format("clip '{}': {:.0f} frames asked for, at most {} possible", clip.name(),
                  num_frames, Clip::kMaxFrames));
}

// `num_frames` frames evenly from the first to the last.
StatusOr<Clip> Spread(const Clip& clip, int num_frames, double frame_rate) {
  const int joints = clip.num_joints();
  const int64_t last = clip.num_frames() - 1;
  const int64_t steps = std::max(num_frames - 1, 1);
  std::vector<Vec3> positions(num_frames);
  std::vector<Quat> rotations(static_cast<size_t>(num_frames) * joints);
  for (int64_t i = 0; i < num_frames; ++i) {
    // Whole numbers, so that a new frame that falls on an old one is that frame exactly.
    const int before = static_cast<int>(i * last / steps);
    const int64_t remainder = i * last % steps;
    const int after = remainder == 0 ? before : before + 1;
    const double u = static_cast<double>(remainder) / static_cast<double>(steps);
    positions[i] = after == before
                       ? clip.root_position(before)
                       : Vec3((1 - u) * clip.root_position(before) + u * clip.root_position(after));
    const auto a = clip.pose(before), b = clip.pose(after);
    Quat* out = rotations.data() + i * joints;
    const math::SlerpAt slerp(u);
    for (int joint = 0; joint < joints; ++joint) out[joint] = slerp(a[joint], b[joint]);
  }
  return Clip::Create(clip.name(), clip.skeleton(), frame_rate, std::move(positions),
                      std::move(rotations));
}

}  // namespace

StatusOr<Clip> Resample(const Clip& clip, double frame_rate) {
  if (!(frame_rate > 0) || !std::isfinite(frame_rate)) {
    return base::InvalidArgument(
        "BAD_FRAME_RATE", "frame_rate",
        fmt::format("clip '{}': cannot resample to {} Hz", clip.name(), frame_rate));
  }
  const double frames = std::round(clip.duration() * frame_rate) + 1;
  POISE_RETURN_IF_ERROR(CheckFrameCount(clip, frames));
  // A clip shorter than half a new frame still has two ends.
  const int least = std::min(clip.num_frames(), 2);
  return Spread(clip, std::max(static_cast<int>(frames), least), frame_rate);
}

StatusOr<Clip> ResampleToFrames(const Clip& clip, int num_frames) {
  POISE_RETURN_IF_ERROR(CheckFrameCount(clip, num_frames));
  if (num_frames < std::min(clip.num_frames(), 2)) {
    return base::InvalidArgument(
        "BAD_FRAME_COUNT", "num_frames",
        fmt::format("clip '{}': {} frames asked for, at least {} keep its first and last pose",
                    clip.name(), num_frames, std::min(clip.num_frames(), 2)));
  }
  return Spread(clip, num_frames, clip.frame_rate());
}

StatusOr<Clip> ResampleToDuration(const Clip& clip, double duration) {
  if (!(duration >= 0) || !std::isfinite(duration)) {
    return base::InvalidArgument(
        "BAD_DURATION", "duration",
        fmt::format("clip '{}': cannot resample to a duration of {} s", clip.name(), duration));
  }
  const double frames = std::round(duration * clip.frame_rate()) + 1;
  POISE_RETURN_IF_ERROR(CheckFrameCount(clip, frames));
  return ResampleToFrames(clip, static_cast<int>(frames));
}

}  // namespace poise::motion
