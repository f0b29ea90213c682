#include "core/motion/editing/cut.h"

#include <fmt/format.h>

namespace poise::motion {
namespace {

// Frames first, first + step, ...: `count` of them.
StatusOr<Clip> Pick(const Clip& clip, int first, int count, int step) {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
  positions.reserve(count);
  rotations.reserve(static_cast<size_t>(count) * clip.num_joints());
  for (int i = 0; i < count; ++i) {
    const int frame = first + i * step;
    positions.push_back(clip.root_position(frame));
    rotations.insert(rotations.end(), clip.pose(frame).begin(), clip.pose(frame).end());
  }
  return Clip::Create(clip.name(), clip.skeleton(), clip.frame_rate() / step, std::move(positions),
                      std::move(rotations));
}

}  // namespace

StatusOr<Clip> Cut(const Clip& clip, int first, int count) {
  if (first < 0 || count < 1 || first > clip.num_frames() - count) {
    return base::InvalidArgument("BAD_FRAME_RANGE", "frames",
                                 fmt::format("clip '{}' has {} frames, wanted {} from frame {} on",
                                             clip.name(), clip.num_frames(), count, first));
  }
  return Pick(clip, first, count, 1);
}

StatusOr<Clip> TakeEvery(const Clip& clip, int step) {
  if (step < 1) {
    return base::InvalidArgument("BAD_STEP", "step",
                                 fmt::format("step is {}, expected at least 1", step));
  }
  return Pick(clip, 0, (clip.num_frames() + step - 1) / step, step);
}

}  // namespace poise::motion
