#ifndef POISE_CORE_MOTION_METRICS_PLACED_BODIES_H_
#define POISE_CORE_MOTION_METRICS_PLACED_BODIES_H_

#include <vector>

#include "core/motion/body_shapes.h"
#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {

/// A body as a capsule in the world: all points within `radius` (see PlacedBodies) of the segment
/// from center - half_axis to center + half_axis. A sphere has half_axis 0; a foot box counts as
/// the capsule of its own length and half width.
struct PlacedCapsule {
  Vec3 center;
  Vec3 half_axis;
};

/// The bodies of every frame, in the world, as the measures need them.
/// Shapes: capsules (frames, 16); lowest (frames), the height of the lowest point of any body;
/// soles (frames, 2 feet, 4 corners), right foot first; radii (16)
struct PlacedBodies {
  static constexpr int kFeet = 2;
  static constexpr int kCorners = 4;

  int num_frames = 0;
  std::array<double, kNumRequiredRoles> radii{};
  std::vector<PlacedCapsule> capsules;
  std::vector<double> lowest;
  std::vector<Vec3> soles;

  const PlacedCapsule* frame(int frame) const {
    return capsules.data() + static_cast<size_t>(frame) * kNumRequiredRoles;
  }
  const Vec3& corner(int frame, int foot, int corner) const {
    return soles[(static_cast<size_t>(frame) * kFeet + foot) * kCorners + corner];
  }
};

/// Into memory of the caller that is reused.
void PlaceBodies(const BodyShapes& shapes, const WorldPoses& world, PlacedBodies& placed);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_PLACED_BODIES_H_
