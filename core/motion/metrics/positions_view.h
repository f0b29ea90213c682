#ifndef POISE_CORE_MOTION_METRICS_POSITIONS_VIEW_H_
#define POISE_CORE_MOTION_METRICS_POSITIONS_VIEW_H_

#include <span>

#include "core/motion/skeleton.h"

namespace poise::motion {

/// Joint positions of a motion, as the distances between motions see it.
/// Shape: positions (frames, joints), frame by frame [m]
struct PositionsView {
  int joints = 1;
  std::span<const Vec3> positions;

  int frames() const { return static_cast<int>(positions.size()) / joints; }
  const Vec3& position(int frame, int joint) const { return positions[frame * joints + joint]; }
  /// From this frame on.
  PositionsView From(int frame) const { return {joints, positions.subspan(frame * joints)}; }
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_POSITIONS_VIEW_H_
