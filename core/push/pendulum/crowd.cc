#include "core/push/pendulum/crowd.h"

#include <algorithm>

#include "core/push/body_joints.h"

namespace poise::push {
namespace {

PendulumStates StatesOf(const PushScene& scene) {
  const int people = static_cast<int>(scene.people.size());
  PendulumStates states{PendulumArray(people, 4), PendulumArray::Zero(people, 4),
                        PersonArray(people)};
  for (int i = 0; i < people; ++i) {
    states.position.row(i) = scene.people[i].pendulum.position.transpose().array();
    states.rod[i] = scene.people[i].pendulum.rod;
  }
  return states;
}

PendulumBodies BodiesOf(const PushScene& scene) {
  const int people = static_cast<int>(scene.people.size());
  PendulumBodies bodies{PersonArray(people), PersonArray(people)};
  for (int i = 0; i < people; ++i) {
    bodies.mass[i] = scene.people[i].mass_kg;
    bodies.cart_height[i] = scene.people[i].pendulum.cart_height;
  }
  return bodies;
}

}  // namespace

Crowd::Crowd(const PushScene& scene, const PhysicsConfig& config)
    : config_(config),
      bodies_(BodiesOf(scene)),
      states_(StatesOf(scene)),
      standing_(states_.position),
      hold_(InverseDynamics(states_, bodies_.mass, PendulumArray::Zero(standing_.rows(), 4))),
      contact_(config, hips().leftCols<2>()),
      interaction_(PendulumArray::Zero(standing_.rows(), 4)),
      floor_force_(Eigen::ArrayX2d::Zero(standing_.rows(), 2)) {}

PendulumArray Crowd::BalanceForces() const {
  const PersonArray inertia = bodies_.mass * states_.rod.square();
  const Eigen::ArrayX2d lean = (states_.position - standing_).rightCols<2>();
  PendulumArray force = hold_;
  // phi > 0 leans to -Y.
  force.col(0) +=
      bodies_.mass * (config_.stepping * lean.col(0) - config_.friction * states_.velocity.col(0));
  force.col(1) +=
      bodies_.mass * (-config_.stepping * lean.col(1) - config_.friction * states_.velocity.col(1));
  for (int axis = 0; axis < 2; ++axis) {
    force.col(2 + axis) -= inertia * (config_.lean_stiffness * lean.col(axis) +
                                      config_.lean_damping * states_.velocity.col(2 + axis));
  }
  return force;
}

void Crowd::Step(const PendulumArray& push) {
  constexpr double kLargestLean = 1.4;  // [rad] the equations are singular at pi / 2
  const double step = kFrameTime / config_.substeps;
  const double share = 1.0 / config_.substeps;
  const PersonArray at_hip = PersonArray::Ones(standing_.rows());
  // Who could come within reach during the frame.
  constexpr double kMargin = 0.15;  // [m] two people at 4.5 m/s towards each other
  const auto& pairs = neighbours_.Find(hips().leftCols<2>(), contact_.range() + kMargin);
  interaction_.setZero();
  floor_force_.setZero();
  for (int i = 0; i < config_.substeps; ++i) {
    Eigen::ArrayX2d contact = Eigen::ArrayX2d::Zero(standing_.rows(), 2);
    contact_.AddForces(pairs, hips().leftCols<2>(), RodEndVelocities(states_).leftCols<2>(),
                       contact);
    const PendulumArray interaction = AtRod(states_, contact, at_hip);
    const PendulumArray balance = BalanceForces();
    states_.velocity += step * Accelerations(states_, bodies_.mass, push + interaction + balance);
    states_.position += step * states_.velocity;
    states_.position.rightCols<2>() =
        states_.position.rightCols<2>().max(-kLargestLean).min(kLargestLean);
    interaction_ += share * interaction;
    floor_force_ += share * balance.leftCols<2>();
  }
}

PendulumArray PushForces(const PushScene& scene, int frame, const PendulumStates& states) {
  const int people = static_cast<int>(states.position.rows());
  Eigen::ArrayX2d force = Eigen::ArrayX2d::Zero(people, 2);
  PendulumArray total = PendulumArray::Zero(people, 4);
  for (const ScenePush& push : scene.pushes) {
    const Eigen::Vector2d now = ForceInFrame(push, frame);
    if (now.isZero()) continue;
    force.row(push.person) = now.transpose().array();
    total += AtRod(states, force, PersonArray::Constant(people, push.height));
    force.row(push.person).setZero();
  }
  return total;
}

}  // namespace poise::push
