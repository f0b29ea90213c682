#ifndef POISE_CORE_MOTION_METRICS_SELF_PENETRATION_H_
#define POISE_CORE_MOTION_METRICS_SELF_PENETRATION_H_

#include <utility>
#include <vector>

#include "core/motion/metrics/placed_bodies.h"

namespace poise::motion {

/// The nearest points of two segments, given by centre and half axis (which may be zero).
struct SegmentGap {
  Vec3 on_a, on_b;  ///< [m]
};
SegmentGap NearestPoints(const PlacedCapsule& a, const PlacedCapsule& b);

/// Their distance [m].
double SegmentDistance(const PlacedCapsule& a, const PlacedCapsule& b);

/// The pairs of bodies that must not overlap: all but those that the tree of bodies brings
/// together. These are parent and child, two bodies of the trunk (pelvis, spine, chest, head), and
/// a limb with the trunk body next to the one that it hangs off.
std::vector<std::pair<int, int>> SeparatePairs(const BodyShapes& shapes);

/// Deepest overlap of any such pair in any frame [m], 0 when there is none.
double WorstSelfPenetration(const BodyShapes& shapes, const PlacedBodies& bodies);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_SELF_PENETRATION_H_
