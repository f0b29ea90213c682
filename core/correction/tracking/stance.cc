#include "core/correction/tracking/stance.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace poise::correction {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using motion::JointRole;

constexpr double kLeastLoad = 0.02;      // a foot that nobody plans to load still can carry
constexpr double kTouching = 0.002;      // [m] a point this near carries
constexpr double kForceSoftness = 1e-3;  // of the force against one point's, for a regular matrix

bool IsFoot(int body) {
  return body == static_cast<int>(JointRole::kRightAnkle) ||
         body == static_cast<int>(JointRole::kLeftAnkle);
}

math::Mat3 Cross(const Vec3& v) {
  math::Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Forces of least squares over the points that are not left out.
void Distribute(const Vec3& at, const Vector6& wrench, double moment_softness,
                const std::array<bool, Stances::kMax>& left_out, Stances& stances) {
  Matrix6 normal = Matrix6::Zero();
  normal.diagonal().head<3>().setConstant(kForceSoftness);
  normal.diagonal().tail<3>().setConstant(moment_softness);
  for (int i = 0; i < stances.count; ++i) {
    if (left_out[i]) continue;
    const math::Mat3 arm = Cross(stances.points[i].point - at);
    const double load = stances.points[i].load;
    normal.topLeftCorner<3, 3>() += load * math::Mat3::Identity();
    normal.topRightCorner<3, 3>() += load * arm.transpose();
    normal.bottomLeftCorner<3, 3>() += load * arm;
    normal.bottomRightCorner<3, 3>() += load * arm * arm.transpose();
  }
  const Vector6 multiplier = normal.ldlt().solve(wrench);
  for (int i = 0; i < stances.count; ++i) {
    Stance& foot = stances.points[i];
    foot.force.setZero();
    if (left_out[i]) continue;
    foot.force = foot.load *
                 (multiplier.head<3>() + Cross(foot.point - at).transpose() * multiplier.tail<3>());
  }
}

void CutToCone(double friction, Vec3& force) {
  force.y() = std::max(force.y(), 0.0);
  const double most = friction * force.y(), sideways = std::hypot(force.x(), force.z());
  if (sideways <= most) return;
  force.x() *= most / sideways;
  force.z() *= most / sideways;
}

}  // namespace

Stances FindStances(const physics::World& world, const std::array<double, 2>& loads) {
  Stances stances;
  for (const physics::ContactPoint& contact : world.contacts()) {
    if (!IsFoot(contact.body) || contact.other >= 0 || contact.distance > kTouching) continue;
    if (stances.count == Stances::kMax) break;
    const bool right = contact.body == static_cast<int>(JointRole::kRightAnkle);
    stances.points[stances.count++] = {.body = contact.body,
                                       .load = std::max(loads[right ? 0 : 1], kLeastLoad),
                                       .point = Eigen::Map<const Vec3>(contact.point),
                                       .force = Vec3::Zero()};
  }
  return stances;
}

void ShareWrench(const Vec3& at, const Vec3& force, const Vec3& torque, const StanceLimits& limits,
                 Stances& stances) {
  Vector6 wrench;
  wrench << force, torque;
  std::array<bool, Stances::kMax> left_out{};
  for (bool pulled = true; pulled;) {
    Distribute(at, wrench, limits.moment_softness_m2, left_out, stances);
    pulled = false;
    for (int i = 0; i < stances.count; ++i) {
      if (stances.points[i].force.y() >= 0) continue;
      left_out[i] = pulled = true;
    }
  }
  for (int i = 0; i < stances.count; ++i) CutToCone(limits.friction, stances.points[i].force);
}

physics::Speeds StanceTorques(const physics::Articulation& tree, const physics::BodyFrames& frames,
                              const Stances& stances) {
  physics::Speeds torques = physics::Speeds::Zero();
  for (int i = 0; i < stances.count; ++i) {
    const Stance& foot = stances.points[i];
    for (int body = foot.body; body > 0; body = tree.bodies[body].parent) {
      torques.segment<3>(physics::SpeedIndex(body)) -=
          frames.rotations[body].conjugate() *
          (foot.point - frames.positions[body]).cross(foot.force);
    }
  }
  return torques;
}

}  // namespace poise::correction
