#ifndef POISE_CORE_PUSH_LEARNED_HEADING_H_
#define POISE_CORE_PUSH_LEARNED_HEADING_H_

#include <cmath>

#include "core/push/ground_frame.h"
#include "core/push/learned/network_layers.h"

/// The networks learned from pushes along +X. Each person is forecast in a frame of its own that is
/// turned about the vertical so that the push comes from behind: its heading.
namespace poise::push {

/// Unit vectors of each person's forward on the floor: (people, 2), ground frame.
using Headings = FloorVectors;

inline Headings FacingX(int people) {
  Headings headings = Headings::Zero(people, 2);
  headings.col(0).setOnes();
  return headings;
}

/// A vector on the floor, from a heading's frame to the ground frame and back. A heading along +X
/// changes nothing, bit for bit.
inline Eigen::RowVector2f ToGround(const Eigen::RowVector2f& heading,
                                   const Eigen::RowVector2f& own) {
  return {heading.x() * own.x() - heading.y() * own.y(),
          heading.y() * own.x() + heading.x() * own.y()};
}
inline Eigen::RowVector2f FromGround(const Eigen::RowVector2f& heading,
                                     const Eigen::RowVector2f& ground) {
  return {heading.x() * ground.x() + heading.y() * ground.y(),
          heading.x() * ground.y() - heading.y() * ground.x()};
}

/// The turn about the vertical from a heading's frame to the ground frame.
inline math::Quat TurnOf(const Eigen::RowVector2f& heading) {
  return math::Quat(Eigen::AngleAxisd(std::atan2(heading.y(), heading.x()), Vec3::UnitZ()));
}

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_HEADING_H_
