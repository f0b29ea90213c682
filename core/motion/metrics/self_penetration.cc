#include "core/motion/metrics/self_penetration.h"

#include <algorithm>
#include <cmath>

namespace poise::motion {
namespace {

bool IsTrunk(const BodyShape& shape) {
  return shape.role == JointRole::kPelvis || shape.role == JointRole::kSpine ||
         shape.role == JointRole::kChest || shape.role == JointRole::kNeck;
}

bool Joined(const BodyShapes& shapes, int a, int b) {
  return shapes[a].parent == b || shapes[b].parent == a;
}

bool BroughtTogether(const BodyShapes& shapes, int a, int b) {
  if (Joined(shapes, a, b)) return true;
  const bool trunk_a = IsTrunk(shapes[a]), trunk_b = IsTrunk(shapes[b]);
  if (trunk_a && trunk_b) return true;
  if (!trunk_a && !trunk_b) return false;
  for (size_t between = 0; between < shapes.size(); ++between) {
    const int middle = static_cast<int>(between);
    if (IsTrunk(shapes[middle]) && Joined(shapes, a, middle) && Joined(shapes, middle, b)) {
      return true;
    }
  }
  return false;
}

}  // namespace

SegmentGap NearestPoints(const PlacedCapsule& a, const PlacedCapsule& b) {
  // Minimise |d + s u - t v| over s, t in [-1, 1]: the free minimum, clamped one after the other.
  const Vec3 &u = a.half_axis, &v = b.half_axis;
  const Vec3 d = a.center - b.center;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double ud = u.dot(d), vd = v.dot(d);
  const double determinant = uu * vv - uv * uv;
  const auto clamp = [](double x) { return std::clamp(x, -1.0, 1.0); };
  double s = determinant > 1e-12 * uu * vv ? clamp((uv * vd - vv * ud) / determinant) : 0;
  const double t = vv > 0 ? clamp((uv * s + vd) / vv) : 0;
  if (uu > 0) s = clamp((uv * t - ud) / uu);
  return {.on_a = a.center + s * u, .on_b = b.center + t * v};
}

double SegmentDistance(const PlacedCapsule& a, const PlacedCapsule& b) {
  const SegmentGap gap = NearestPoints(a, b);
  return (gap.on_a - gap.on_b).norm();
}

std::vector<std::pair<int, int>> SeparatePairs(const BodyShapes& shapes) {
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < kNumRequiredRoles; ++a) {
    for (int b = a + 1; b < kNumRequiredRoles; ++b) {
      if (!BroughtTogether(shapes, a, b)) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

double WorstSelfPenetration(const BodyShapes& shapes, const PlacedBodies& bodies) {
  struct Pair {
    int a, b;
    double reach;   // sum of the bounding spheres' radii
    double radius;  // sum of the capsules' radii
  };
  std::vector<Pair> pairs;
  const PlacedCapsule* first = bodies.frame(0);
  for (const auto& [a, b] : SeparatePairs(shapes)) {
    const double radius = bodies.radii[a] + bodies.radii[b];
    pairs.push_back({a, b, radius + first[a].half_axis.norm() + first[b].half_axis.norm(), radius});
  }
  double worst = 0;
  for (int frame = 0; frame < bodies.num_frames; ++frame) {
    const PlacedCapsule* capsules = bodies.frame(frame);
    for (const Pair& pair : pairs) {
      // Bounding spheres first, already less the worst overlap so far.
      const PlacedCapsule &a = capsules[pair.a], &b = capsules[pair.b];
      const double near = pair.reach - worst;
      if ((a.center - b.center).squaredNorm() >= near * near) continue;
      worst = std::max(worst, pair.radius - SegmentDistance(a, b));
    }
  }
  return worst;
}

}  // namespace poise::motion
