#ifndef POISE_CORE_PHYSICS_KERNEL_CONTROLLER_H_
#define POISE_CORE_PHYSICS_KERNEL_CONTROLLER_H_

#include <cmath>

#include "core/physics/kernel/factor.h"
#include "core/physics/step_types.h"

/// Stable PD (Tan, Liu, Turk 2011) on every joint, with the residual wrench on the root inside the
/// same implicit solve, so that stiff gains stay calm at the step's length.
namespace poise::physics::POISE_KERNEL_ISA {

/// Rotation of a turn by `vector` (axis times angle).
inline Q4 Exponential(const V3& vector) {
  const double half2 = vector.squaredNorm() / 4;
  double c, s;  // cos and sin(x) / x of half the angle
  if (half2 < 0.01) {
    c = 1 - half2 / 2 * (1 - half2 / 12 * (1 - half2 / 30 * (1 - half2 / 56)));
    s = 1 - half2 / 6 * (1 - half2 / 20 * (1 - half2 / 42 * (1 - half2 / 72)));
  } else {
    const double half = std::sqrt(half2);
    c = std::cos(half);
    s = std::sin(half) / half;
  }
  const V3 v = s / 2 * vector;
  return Q4(c, v.x(), v.y(), v.z());
}

/// Inverse, the short way round.
inline V3 Logarithm(const Q4& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double s = q.vec().norm();
  if (s < 1e-9) return 2 * sign * q.vec();
  return 2 * sign * std::atan2(s, sign * q.w()) / s * q.vec();
}

/// Torques of the joints and wrench at the root, in the layout of forces, into `forces`; what of it
/// is the residual's and the limits' doing, into `effort`. `bias` is the bias force.
struct ControlInput {
  const Articulation& tree;
  const StepSettings& settings;
  const StepDrive& drive;
  const StepState& state;
  const Topology& topology;
  const double* bias;
};

/// The force of springs and dampers that the end of the step will see, without what the step's own
/// acceleration adds.
inline void SpringForces(const ControlInput& in, double* springs) {
  const double step = in.settings.step_s;
  const double* u = in.state.speeds;
  const double* wanted = in.drive.target_speeds;
  const StepDrive& drive = in.drive;
  const V3 ahead = Vec(in.state.root_position) + step * Vec(u);
  const V3 lag = drive.target_root ? V3(Vec(drive.target_root) - ahead) : V3(V3::Zero());
  Vec(springs) = drive.root_stiffness[0] * lag + drive.root_damping[0] * (Vec(wanted) - Vec(u));
  using ConstQ4 = Eigen::Map<const Q4>;
  const Q4 turned = Exponential(step * Vec(u + 3)) * ConstQ4(in.state.rotations);
  Vec(springs + 3) =
      drive.root_stiffness[1] * Logarithm(ConstQ4(drive.target_rotations) * turned.conjugate()) +
      drive.root_damping[1] * (Vec(wanted + 3) - Vec(u + 3));
  for (int i = 1; i < in.tree.num_bodies; ++i) {
    const Body& body = in.tree.bodies[i];
    const int at = 3 + 3 * i;
    if (body.rigid_joint || (body.stiffness == 0 && body.damping == 0)) {
      Vec(springs + at).setZero();
      continue;
    }
    const Q4 next = ConstQ4(in.state.rotations + 4 * i) * Exponential(step * Vec(u + at));
    const V3 error = Logarithm(next.conjugate() * ConstQ4(drive.target_rotations + 4 * i));
    Vec(springs + at) = body.stiffness * error + body.damping * (Vec(wanted + at) - Vec(u + at));
  }
}

inline void NodeDampings(const ControlInput& in, double* damping) {
  damping[0] = in.settings.step_s * in.drive.root_damping[0];
  damping[1] = in.settings.step_s * in.drive.root_damping[1];
  for (int i = 1; i < in.tree.num_bodies; ++i) {
    const Body& body = in.tree.bodies[i];
    damping[i + 1] = body.rigid_joint ? 0 : in.settings.step_s * body.damping;
  }
}

inline void Control(const ControlInput& in, MassBlocks mass, double* forces, StepEffort& effort) {
  const int speeds = in.tree.num_speeds();
  double springs[kMaxSpeeds], acceleration[kMaxSpeeds], damping[kMaxNodes];
  SpringForces(in, springs);
  NodeDampings(in, damping);
  for (int i = 0; i < speeds; ++i) {
    acceleration[i] = springs[i];
    if (in.drive.predict_bias) {
      acceleration[i] -= in.bias[i];
      if (in.drive.feed_forward && i >= 6) acceleration[i] += in.drive.feed_forward[i];
    }
  }
  Factor factor;
  FactorInPlace(in.topology, mass, damping, factor);
  Solve(in.topology, factor, acceleration);
  // The ground takes the weight, which the prediction does not know: without this the residual
  // would hold up against a fall that does not happen.
  if (in.drive.predict_bias && !in.tree.fixed_base) {
    Vec(acceleration) -= Vec(in.settings.gravity);
  }
  effort.num_saturated = 0;
  for (int n = 0; n < in.topology.num_nodes; ++n) {
    V3 force = Vec(springs + 3 * n) - damping[n] * Vec(acceleration + 3 * n);
    if (in.drive.feed_forward) force += Vec(in.drive.feed_forward + 3 * n);
    if (n < 2) {
      Vec(effort.residual + 3 * n) = force;
      Vec(effort.torques + 3 * n).setZero();
    } else {
      const Body& body = in.tree.bodies[n - 1];
      const double length = force.norm();
      if (body.rigid_joint) force.setZero();
      if (body.torque_limit > 0 && length > body.torque_limit) {
        force *= body.torque_limit / length;
        ++effort.num_saturated;
      }
      Vec(effort.torques + 3 * n) = force;
    }
    Vec(forces + 3 * n) = force;
  }
}

}  // namespace poise::physics::POISE_KERNEL_ISA

#endif  // POISE_CORE_PHYSICS_KERNEL_CONTROLLER_H_
