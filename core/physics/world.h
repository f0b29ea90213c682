#ifndef POISE_CORE_PHYSICS_WORLD_H_
#define POISE_CORE_PHYSICS_WORLD_H_

#include <memory>
#include <span>

#include "core/physics/humanoid_model.h"
#include "core/physics/state.h"
#include "core/physics/step_types.h"
#include "core/physics/world_config.h"

namespace poise::physics {

/// What the controller is to do during a step.
struct Drive {
  /// Joints' PD targets; [0] is the root's target in the world, for the residual.
  std::array<Quat, kMaxBodies> target_rotations;
  /// Target velocities; the root's are for the residual.
  Speeds target_speeds = Speeds::Zero();
  Vec3 target_root = Vec3::Zero();  ///< [m]
  /// Added to the joints' torques, before their limits; at the root an outer wrench in world axes,
  /// which the prediction does not know.
  Speeds feed_forward = Speeds::Zero();
  /// Whether the stable PD's prediction contains gravity, Coriolis and the feed-forward. Off where
  /// the feed-forward is an inverse dynamics, which cancels them.
  bool predict_bias = true;
  /// PD wrench on the root, implicit like the joints' PD; all 0: none.
  ResidualGains residual = ResidualGains{}.Scaled(0);

  Drive() { target_rotations.fill(Quat::Identity()); }
};

/// What a step exerted.
struct Effort {
  Speeds torques = Speeds::Zero();      ///< [N m] of the joints, within their limits
  Vec3 residual_force = Vec3::Zero();   ///< [N] outer force on the root, in world axes
  Vec3 residual_torque = Vec3::Zero();  ///< [N m]
  int saturated_joints = 0;
};

class BulletEngine;

/// One articulation on level ground (y = 0), and its controller. A step evaluates the controller
/// (stable PD: Tan, Liu, Turk 2011; with the residual wrench inside the same implicit solve) and
/// moves on by 1 / rate_hz, without allocating.
/// Own engine: composite rigid bodies, the tree's sparse factors, contacts by projected
/// Gauss-Seidel at velocity level, semi-implicit Euler; the same state and drive give the same step
/// to the bit on the same instruction set.
/// Threads: one caller at a time; worlds share nothing but the constant articulation.
class World {
 public:
  /// `articulation` is copied. Errors: kInvalidArgument BAD_ARTICULATION (not 1 to 16 bodies, a
  /// parent that does not come first, a chain of more than 6 joints, a mass or inertia that is not
  /// positive), CONFIG_VALUE_OUT_OF_RANGE, UNSUPPORTED_ENGINE (Bullet with a fixed base).
  static StatusOr<World> Create(const Articulation& articulation, const WorldConfig& config = {});

  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  const Articulation& articulation() const { return *articulation_; }
  const WorldConfig& config() const { return config_; }
  double step_s() const { return settings_.step_s; }
  Vec3 gravity() const { return -config_.gravity_mps2 * Vec3::UnitY(); }

  const State& state() const { return state_; }
  /// Places the bodies; contacts are forgotten. Rotations are taken as unit quaternions; a rigid
  /// joint keeps the rotation given here and has no speed.
  void Reset(const State& state);
  void Step(const Drive& drive);
  /// Contacts and effort of the last step; empty after Reset.
  std::span<const ContactPoint> contacts() const;
  const Effort& effort() const { return effort_; }

  /// All that the own engine remembers, to go on from exactly; with Bullet a Restore is a Reset.
  StepState Save() const { return memory_; }
  void Restore(const StepState& saved);

 private:
  World(const Articulation& articulation, const WorldConfig& config);
  StepDrive PlainDrive(const Drive& drive) const;
  void ReadMemory();

  std::unique_ptr<const Articulation> articulation_;
  WorldConfig config_;
  StepSettings settings_;
  State state_;
  StepState memory_;
  Effort effort_;
  std::unique_ptr<BulletEngine> bullet_;  // none: own engine
};

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_WORLD_H_
