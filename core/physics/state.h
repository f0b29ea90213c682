#ifndef POISE_CORE_PHYSICS_STATE_H_
#define POISE_CORE_PHYSICS_STATE_H_

#include <Eigen/Core>
#include <array>

#include "core/math/rotation.h"
#include "core/physics/articulation.h"

namespace poise::physics {

using math::Quat;
using math::Vec3;

/// Velocities, accelerations or forces of all joints, in the layout of articulation.h: root linear
/// and angular in world axes, then each joint's in the axes of the body below it.
using Speeds = Eigen::Matrix<double, kMaxSpeeds, 1>;
using MassMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

/// Position and velocity of an articulation.
struct State {
  Vec3 root_position = Vec3::Zero();
  /// Local to the parent's body; the root's from body to world. All identity at first.
  std::array<Quat, kMaxBodies> rotations;
  Speeds speeds = Speeds::Zero();

  State() { rotations.fill(Quat::Identity()); }
};

/// Index of a body's three numbers in Speeds; of the root the angular ones.
constexpr int SpeedIndex(int body) { return 3 + 3 * body; }

/// Where each body is in the world.
struct BodyFrames {
  std::array<Vec3, kMaxBodies> positions;  ///< [m] of the joint
  std::array<Quat, kMaxBodies> rotations;  ///< world from body
};

BodyFrames ComputeFrames(const Articulation& tree, const State& state);

/// Force that gives these accelerations under this gravity without contacts; with zero
/// accelerations the bias force.
Speeds InverseDynamics(const Articulation& tree, const State& state, const Speeds& accelerations,
                       const Vec3& gravity);
Speeds BiasForce(const Articulation& tree, const State& state, const Vec3& gravity);

/// (speeds, speeds); rows of rigid joints and of a fixed base are those of the unit matrix.
MassMatrix ComputeMassMatrix(const Articulation& tree, const State& state);

/// Momentum and energy of the whole.
struct Conserved {
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< [kg m2/s] about the world's origin
  double kinetic_energy = 0;             ///< [J]
  double potential_energy = 0;           ///< [J] 0 at the world's origin
};

Conserved ComputeConserved(const Articulation& tree, const State& state, const Vec3& gravity);

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_STATE_H_
