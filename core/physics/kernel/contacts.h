#ifndef POISE_CORE_PHYSICS_KERNEL_CONTACTS_H_
#define POISE_CORE_PHYSICS_KERNEL_CONTACTS_H_

#include <algorithm>
#include <cmath>

#include "core/physics/kernel/tree.h"
#include "core/physics/step_types.h"

/// Where bodies touch the ground (y = 0) and each other. Spheres, capsules and boxes against the
/// ground are exact; against each other a box counts as the capsule of its length and half width,
/// as in motion/metrics.
namespace poise::physics::POISE_KERNEL_ISA {

inline constexpr double kContactMargin = 0.002;  ///< [m] a point this near may touch in this step

struct Candidate {
  int body, other, feature;
  V3 point;   ///< relative to the root
  V3 normal;  ///< towards `body`
  double distance;
};

struct Candidates {
  int count = 0;
  Candidate list[kMaxContacts];
};

inline void Offer(Candidates& found, const Kinematics& k, double step, const Candidate& candidate) {
  const int a = candidate.body, b = candidate.other;
  V3 velocity = k.linear[a] + k.angular[a].cross(candidate.point - k.joint[a]);
  if (b >= 0) velocity -= k.linear[b] + k.angular[b].cross(candidate.point - k.joint[b]);
  const double approach = std::max(0.0, -candidate.normal.dot(velocity));
  if (candidate.distance > kContactMargin + 2 * step * approach) return;
  if (found.count < kMaxContacts) found.list[found.count++] = candidate;
}

inline void FindGroundContacts(const Articulation& tree, const Kinematics& k, double root_height,
                               double step, Candidates& found) {
  const V3 up = V3::UnitY();
  for (int i = 0; i < tree.num_bodies; ++i) {
    const Body& body = tree.bodies[i];
    if (body.geometry == Geometry::kNone) continue;
    const V3 center = k.joint[i] + k.rotation[i] * Vec(body.shape_center);
    const auto offer = [&](int feature, const V3& lowest) {
      Offer(found, k, step, {i, -1, feature, lowest, up, root_height + lowest.y()});
    };
    const double reach = body.radius + body.half_length + Vec(body.half_extents).norm();
    const double fall = std::abs(k.linear[i].y()) + k.angular[i].norm() * 2 * reach;
    if (root_height + center.y() - reach > kContactMargin + 2 * step * fall) continue;
    const M3 axes = k.rotation[i] * ConstM3(body.shape_axes);
    if (body.geometry == Geometry::kSphere) {
      offer(0, center - body.radius * up);
    } else if (body.geometry == Geometry::kCapsule) {
      const V3 half = body.half_length * axes.col(1);
      offer(0, center + half - body.radius * up);
      offer(1, center - half - body.radius * up);
    } else {
      for (int corner = 0; corner < 8; ++corner) {
        const V3 signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        offer(corner, center + axes * signs.cwiseProduct(Vec(body.half_extents)));
      }
    }
  }
}

/// A body as all points within `radius` of a segment.
struct Rod {
  V3 center, half;
  double radius, reach;
};

inline Rod MakeRod(const Body& body, const Kinematics& k, int i) {
  Rod rod;
  rod.center = k.joint[i] + k.rotation[i] * Vec(body.shape_center);
  rod.half.setZero();
  rod.radius = body.radius;
  if (body.geometry == Geometry::kCapsule) {
    rod.half = body.half_length * (k.rotation[i] * Vec(body.shape_axes + 3));
  } else if (body.geometry == Geometry::kBox) {
    rod.radius = body.half_extents[2];
    rod.half =
        std::max(body.half_extents[0] - rod.radius, 0.0) * (k.rotation[i] * Vec(body.shape_axes));
  }
  rod.reach = rod.half.norm() + rod.radius;
  return rod;
}

/// Nearest points of two segments center +- half, as factors of half in [-1, 1].
inline void NearestOnSegments(const Rod& a, const Rod& b, double& s, double& t) {
  const V3 d = a.center - b.center;
  const double aa = a.half.squaredNorm(), bb = b.half.squaredNorm(), ab = a.half.dot(b.half);
  const double ad = a.half.dot(d), bd = b.half.dot(d);
  const auto clamp = [](double x) { return std::clamp(x, -1.0, 1.0); };
  const double determinant = aa * bb - ab * ab;
  s = determinant > 1e-9 * aa * bb ? clamp((ab * bd - bb * ad) / determinant) : 0;
  t = bb > 0 ? clamp((ab * s + bd) / bb) : 0;
  s = aa > 0 ? clamp((ab * t - ad) / aa) : 0;
}

inline void FindSelfContacts(const Articulation& tree, const Kinematics& k, double step,
                             Candidates& found) {
  Rod rods[kMaxBodies];
  for (int i = 0; i < tree.num_bodies; ++i) rods[i] = MakeRod(tree.bodies[i], k, i);
  for (int i = 1; i < tree.num_bodies; ++i) {
    for (int j = 0; j < i; ++j) {
      const Rod &a = rods[i], &b = rods[j];
      const double near = a.reach + b.reach + kContactMargin;
      if ((a.center - b.center).squaredNorm() > near * near) continue;
      if (tree.bodies[i].parent == j || tree.bodies[j].parent == i) continue;
      if (tree.bodies[i].geometry == Geometry::kNone ||
          tree.bodies[j].geometry == Geometry::kNone) {
        continue;
      }
      double s, t;
      NearestOnSegments(a, b, s, t);
      const V3 on_a = a.center + s * a.half, on_b = b.center + t * b.half;
      const V3 apart = on_a - on_b;
      const double length = apart.norm();
      const V3 normal = length > 1e-9 ? V3(apart / length) : V3(V3::UnitY());
      Offer(found, k, step,
            {i, j, 0, on_a - a.radius * normal, normal, length - a.radius - b.radius});
    }
  }
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_CONTACTS_H_
