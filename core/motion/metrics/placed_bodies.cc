#include "core/motion/metrics/placed_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace poise::motion {
namespace {

// A shape as constant vectors in its joint's frame, so that a frame costs rotations only.
struct Template {
  Vec3 center;
  Vec3 half_axis = Vec3::Zero();
  Vec3 half_thickness = Vec3::Zero();  // of a box: centre to instep
  Vec3 half_width = Vec3::Zero();
  Vec3 half_extent = Vec3::Zero();  // of a box: along its length, to its very end
  double radius = 0;
};

Template MakeTemplate(const BodyShape& shape) {
  Template made{.center = shape.center, .radius = shape.radius};
  if (shape.kind == ShapeKind::kCapsule) {
    made.half_axis = shape.orientation * Vec3(0, shape.half_length, 0);
  } else if (shape.kind == ShapeKind::kBox) {
    const Vec3& half = shape.half_extents;
    made.radius = half.z();
    made.half_extent = shape.orientation * Vec3(half.x(), 0, 0);
    made.half_axis = shape.orientation * Vec3(std::max(half.x() - half.z(), 0.0), 0, 0);
    made.half_thickness = shape.orientation * Vec3(0, half.y(), 0);
    made.half_width = shape.orientation * Vec3(0, 0, half.z());
  }
  return made;
}

}  // namespace

void PlaceBodies(const BodyShapes& shapes, const WorldPoses& world, PlacedBodies& placed) {
  std::array<Template, kNumRequiredRoles> templates;
  placed.num_frames = world.num_frames;
  for (int i = 0; i < kNumRequiredRoles; ++i) {
    templates[i] = MakeTemplate(shapes[i]);
    placed.radii[i] = templates[i].radius;
  }
  placed.capsules.clear();
  placed.lowest.clear();
  placed.soles.clear();
  placed.capsules.reserve(static_cast<size_t>(world.num_frames) * kNumRequiredRoles);
  placed.soles.reserve(static_cast<size_t>(world.num_frames) * PlacedBodies::kFeet *
                       PlacedBodies::kCorners);
  for (int frame = 0; frame < world.num_frames; ++frame) {
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kNumRequiredRoles; ++i) {
      const Template& body = templates[i];
      const math::Mat3 turn = world.rotation(frame, shapes[i].joint).toRotationMatrix();
      const Vec3 center = world.position(frame, shapes[i].joint) + turn * body.center;
      const Vec3 half_axis = turn * body.half_axis;
      placed.capsules.push_back({center, half_axis});
      if (shapes[i].kind != ShapeKind::kBox) {
        lowest = std::min(lowest, center.y() - std::abs(half_axis.y()) - body.radius);
        continue;
      }
      const Vec3 length = turn * body.half_extent, width = turn * body.half_width;
      const Vec3 thickness = turn * body.half_thickness;
      lowest = std::min(lowest, center.y() - std::abs(length.y()) - std::abs(width.y()) -
                                    std::abs(thickness.y()));
      const Vec3 sole = center - thickness;
      placed.soles.push_back(sole - length - width);
      placed.soles.push_back(sole - length + width);
      placed.soles.push_back(sole + length - width);
      placed.soles.push_back(sole + length + width);
    }
    placed.lowest.push_back(lowest);
  }
}

}  // namespace poise::motion
