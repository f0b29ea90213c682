#include "core/physics/floor_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::physics {

double FloorHeight(const motion::Clip& clip, const motion::BodyShapes& shapes, FloorRule rule) {
  const motion::WorldPoses world = motion::ForwardKinematics(clip);
  std::vector<double> lowest(world.num_frames, std::numeric_limits<double>::infinity());
  for (const motion::BodyShape& shape : shapes) {
    if (shape.kind != motion::ShapeKind::kBox) continue;
    for (int frame = 0; frame < world.num_frames; ++frame) {
      const math::Mat3 axes =
          (world.rotation(frame, shape.joint) * shape.orientation).toRotationMatrix();
      const double height = world.Point(frame, shape.joint, shape.center).y() -
                            axes.row(1).cwiseAbs().dot(shape.half_extents);
      lowest[frame] = std::min(lowest[frame], height);
    }
  }
  if (rule == FloorRule::kLowest) return *std::min_element(lowest.begin(), lowest.end());
  const auto middle = lowest.begin() + lowest.size() / 2;
  std::nth_element(lowest.begin(), middle, lowest.end());
  return *middle;
}

motion::Clip AlignToFloor(motion::Clip clip, const motion::BodyShapes& shapes, FloorRule rule) {
  const double floor = FloorHeight(clip, shapes, rule);
  for (int frame = 0; frame < clip.num_frames(); ++frame) clip.root_position(frame).y() -= floor;
  return clip;
}

}  // namespace poise::physics
