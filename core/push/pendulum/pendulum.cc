#include "core/push/pendulum/pendulum.h"

#include <cmath>

namespace poise::push {
namespace {

// Sines and cosines of the lean, and the masses: what the equations are made of.
struct Terms {
  Terms(const PendulumStates& states, const PersonArray& mass)
      : sin_theta(states.position.col(2).sin()),
        cos_theta(states.position.col(2).cos()),
        sin_phi(states.position.col(3).sin()),
        cos_phi(states.position.col(3).cos()),
        bob((1 - kCartFraction) * mass),
        bob_rod(bob * states.rod) {}

  PersonArray sin_theta, cos_theta, sin_phi, cos_phi;
  PersonArray bob;      // mass at the rod's end
  PersonArray bob_rod;  // times the rod length
};

// The entries of M that differ from person to person: [total 0 a 0; 0 total b d; a b i 0; 0 d 0 j].
struct Inertia {
  Inertia(const Terms& t, const PersonArray& rod)
      : a(t.bob_rod * t.cos_theta),
        b(t.bob_rod * t.sin_theta * t.sin_phi),
        d(-t.bob_rod * t.cos_theta * t.cos_phi),
        i(t.bob_rod * rod),
        j(i * t.cos_theta.square()) {}

  PersonArray a, b, d, i, j;
};

// C + G.
PendulumArray VelocityAndGravityForces(const PendulumStates& states, const Terms& t) {
  const auto theta_rate = states.velocity.col(2);
  const auto phi_rate = states.velocity.col(3);
  const PersonArray inertia = t.bob_rod * states.rod;
  const PersonArray weight = kGravity * t.bob_rod;
  PendulumArray force(states.position.rows(), 4);
  force.col(0) = -t.bob_rod * t.sin_theta * theta_rate.square();
  force.col(1) = t.bob_rod * (2 * t.sin_theta * t.cos_phi * theta_rate * phi_rate +
                              t.cos_theta * t.sin_phi * (theta_rate.square() + phi_rate.square()));
  force.col(2) =
      inertia * t.sin_theta * t.cos_theta * phi_rate.square() - weight * t.sin_theta * t.cos_phi;
  force.col(3) = -2 * inertia * t.sin_theta * t.cos_theta * theta_rate * phi_rate -
                 weight * t.cos_theta * t.sin_phi;
  return force;
}

}  // namespace

PendulumArray Accelerations(const PendulumStates& states, const PersonArray& mass,
                            const PendulumArray& force) {
  const Terms t(states, mass);
  const Inertia m(t, states.rod);
  const PendulumArray right = force - VelocityAndGravityForces(states, t);
  // The cart's rows are solved for x and y and put into the other two: two equations for the
  // angles.
  const PersonArray m33 = m.i - (m.a.square() + m.b.square()) / mass;
  const PersonArray m34 = -m.b * m.d / mass;
  const PersonArray m44 = m.j - m.d.square() / mass;
  const PersonArray r3 = right.col(2) - (m.a * right.col(0) + m.b * right.col(1)) / mass;
  const PersonArray r4 = right.col(3) - m.d * right.col(1) / mass;
  const PersonArray determinant = m33 * m44 - m34.square();
  PendulumArray acceleration(force.rows(), 4);
  acceleration.col(2) = (m44 * r3 - m34 * r4) / determinant;
  acceleration.col(3) = (m33 * r4 - m34 * r3) / determinant;
  acceleration.col(0) = (right.col(0) - m.a * acceleration.col(2)) / mass;
  acceleration.col(1) =
      (right.col(1) - m.b * acceleration.col(2) - m.d * acceleration.col(3)) / mass;
  return acceleration;
}

PendulumArray InverseDynamics(const PendulumStates& states, const PersonArray& mass,
                              const PendulumArray& acceleration) {
  const Terms t(states, mass);
  const Inertia m(t, states.rod);
  const auto& q = acceleration;
  PendulumArray force = VelocityAndGravityForces(states, t);
  force.col(0) += mass * q.col(0) + m.a * q.col(2);
  force.col(1) += mass * q.col(1) + m.b * q.col(2) + m.d * q.col(3);
  force.col(2) += m.a * q.col(0) + m.b * q.col(1) + m.i * q.col(2);
  force.col(3) += m.d * q.col(1) + m.j * q.col(3);
  return force;
}

PersonArray Energy(const PendulumStates& states, const PersonArray& mass) {
  const Eigen::ArrayX3d bob = RodEndVelocities(states);
  const PersonArray cart = states.velocity.leftCols(2).square().rowwise().sum();
  const PersonArray height =
      states.rod * states.position.col(2).cos() * states.position.col(3).cos();
  return mass * (0.5 * kCartFraction * cart +
                 (1 - kCartFraction) * (0.5 * bob.square().rowwise().sum() + kGravity * height));
}

Eigen::ArrayX2d HorizontalMomentum(const PendulumStates& states, const PersonArray& mass) {
  const Eigen::ArrayX2d velocity = kCartFraction * states.velocity.leftCols(2) +
                                   (1 - kCartFraction) * RodEndVelocities(states).leftCols(2);
  return velocity.colwise() * mass;
}

Eigen::ArrayX3d RodEnds(const PendulumStates& states, const PersonArray& cart_height) {
  const PersonArray level = states.rod * states.position.col(2).cos();
  Eigen::ArrayX3d ends(states.position.rows(), 3);
  ends.col(0) = states.position.col(0) + states.rod * states.position.col(2).sin();
  ends.col(1) = states.position.col(1) - level * states.position.col(3).sin();
  ends.col(2) = cart_height + level * states.position.col(3).cos();
  return ends;
}

Eigen::ArrayX3d RodEndVelocities(const PendulumStates& states) {
  const PersonArray sin_theta = states.position.col(2).sin(),
                    cos_theta = states.position.col(2).cos();
  const PersonArray sin_phi = states.position.col(3).sin(), cos_phi = states.position.col(3).cos();
  const PersonArray theta = states.rod * states.velocity.col(2);
  const PersonArray phi = states.rod * states.velocity.col(3);
  Eigen::ArrayX3d velocities(states.position.rows(), 3);
  velocities.col(0) = states.velocity.col(0) + cos_theta * theta;
  velocities.col(1) =
      states.velocity.col(1) + sin_theta * sin_phi * theta - cos_theta * cos_phi * phi;
  velocities.col(2) = -sin_theta * cos_phi * theta - cos_theta * sin_phi * phi;
  return velocities;
}

PendulumArray AtRod(const PendulumStates& states, const Eigen::ArrayX2d& force,
                    const PersonArray& height) {
  const PersonArray sin_theta = states.position.col(2).sin(),
                    cos_theta = states.position.col(2).cos();
  const PersonArray sin_phi = states.position.col(3).sin(), cos_phi = states.position.col(3).cos();
  const PersonArray arm = height * states.rod;
  PendulumArray generalised(force.rows(), 4);
  generalised.leftCols(2) = force;
  generalised.col(2) = arm * (force.col(0) * cos_theta + force.col(1) * sin_theta * sin_phi);
  generalised.col(3) = -arm * force.col(1) * cos_theta * cos_phi;
  return generalised;
}

PendulumPose PendulumOf(const Vec3& hip, const Vec3& right_ankle, const Vec3& left_ankle) {
  const Vec3 cart = (right_ankle + left_ankle) / 2;
  const Vec3 rod = hip - cart;
  const double theta = std::asin(rod.x() / rod.norm());
  const double phi = std::atan2(-rod.y(), rod.z());
  return {.position = {cart.x(), cart.y(), theta, phi}, .rod = rod.norm(), .cart_height = cart.z()};
}

PendulumPose PaperPendulumOf(const Vec3& hip, const Vec3& right_ankle, const Vec3& left_ankle) {
  PendulumPose pose = PendulumOf(hip, right_ankle, left_ankle);
  const Vec3 rod = (hip - (right_ankle + left_ankle) / 2) / pose.rod;
  pose.position[3] = std::asin(-rod.y());
  pose.position[2] = std::asin(rod.x() / std::cos(pose.position[3]));
  return pose;
}

}  // namespace poise::push
