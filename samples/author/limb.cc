#include "samples/author/limb.h"

#include <algorithm>
#include <cmath>

namespace poise::samples {

using math::Mat3;
using math::Quat;
using math::Vec3;

LimbPose ReachGoal(const Vec3& base, const Vec3& goal, const Vec3& pole, double upper_length,
                   double lower_length) {
  const double longest = 0.999 * (upper_length + lower_length);
  const double shortest = std::abs(upper_length - lower_length) + 1e-3;
  const Vec3 direction = (goal - base).normalized();
  const double distance = std::clamp((goal - base).norm(), shortest, longest);
  const Vec3 side = (pole - direction * direction.dot(pole)).normalized();
  // Law of cosines: the angle at the base, and the hinge's deviation from straight.
  const double base_cos =
      (upper_length * upper_length + distance * distance - lower_length * lower_length) /
      (2 * upper_length * distance);
  const double flexion_cos =
      (distance * distance - upper_length * upper_length - lower_length * lower_length) /
      (2 * upper_length * lower_length);
  LimbPose pose;
  pose.upper = direction * base_cos + side * std::sqrt(std::max(0.0, 1 - base_cos * base_cos));
  pose.hinge = side.cross(direction);
  pose.flexion = std::acos(std::clamp(flexion_cos, -1.0, 1.0));
  return pose;
}

LimbPose Blend(const LimbPose& a, const LimbPose& b, double weight) {
  LimbPose pose;
  pose.upper = (a.upper * (1 - weight) + b.upper * weight).normalized();
  const Vec3 hinge = a.hinge * (1 - weight) + b.hinge * weight;
  pose.hinge = (hinge - pose.upper * pose.upper.dot(hinge)).normalized();
  pose.flexion = a.flexion * (1 - weight) + b.flexion * weight;
  return pose;
}

Quat TurnBone(const Vec3& rest_bone, const Vec3& rest_hinge, const Vec3& bone, const Vec3& hinge) {
  Mat3 rest, now;
  rest << rest_bone, rest_hinge, rest_bone.cross(rest_hinge);
  now << bone, hinge, bone.cross(hinge);
  return Quat(Mat3(now * rest.transpose()));
}

}  // namespace poise::samples
