#include "core/motion/kinematics/fabrik.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace poise::motion {
namespace {

// The point at `length` from `from` on the ray towards `through`.
Vec3 OnRay(const Vec3& from, const Vec3& through, double length) {
  const Vec3 ray = through - from;
  const double norm = ray.norm();
  // Coincident joints leave the direction free: any will do, the next pass corrects it.
  return from + (norm > 0 ? Vec3(ray * (length / norm)) : Vec3(0, length, 0));
}

}  // namespace

FabrikResult SolveFabrik(std::span<Vec3> joints, std::span<const double> lengths,
                         const Vec3& target, const FabrikOptions& options) {
  const size_t bones = lengths.size();
  const Vec3 base = joints[0];
  const auto error = [&] { return (joints[bones] - target).norm(); };
  const double reach = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  if ((target - base).norm() >= reach) {
    for (size_t i = 0; i < bones; ++i) joints[i + 1] = OnRay(joints[i], target, lengths[i]);
    return {.iterations = 1, .error_m = error()};
  }
  FabrikResult result;
  while (result.iterations < options.max_iterations && error() > options.tolerance) {
    joints[bones] = target;
    for (size_t i = bones; i-- > 0;) joints[i] = OnRay(joints[i + 1], joints[i], lengths[i]);
    joints[0] = base;
    for (size_t i = 0; i < bones; ++i) joints[i + 1] = OnRay(joints[i], joints[i + 1], lengths[i]);
    ++result.iterations;
  }
  result.error_m = error();
  return result;
}

Vec3 SolveTwoBones(const Vec3& base, const Vec3& middle, double upper, double lower,
                   const Vec3& target) {
  const Vec3 line = target - base;
  const double distance = line.norm();
  const Vec3 along = distance > 0 ? Vec3(line / distance) : Vec3::UnitY();
  const Vec3 arm = middle - base;
  Vec3 side = arm - along * along.dot(arm);
  const double side_length = side.norm();
  side = side_length > 0 ? Vec3(side / side_length) : along.unitOrthogonal();
  // Law of cosines in the triangle base, middle, target.
  const double cosine =
      distance > 0 ? (upper * upper + distance * distance - lower * lower) / (2 * upper * distance)
                   : 0;
  const double clamped = std::clamp(cosine, -1.0, 1.0);
  return base + upper * (clamped * along + std::sqrt(1 - clamped * clamped) * side);
}

}  // namespace poise::motion
