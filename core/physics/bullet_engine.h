#ifndef POISE_CORE_PHYSICS_BULLET_ENGINE_H_
#define POISE_CORE_PHYSICS_BULLET_ENGINE_H_

#include <memory>

#include "core/physics/state.h"
#include "core/physics/step_types.h"

namespace poise::physics {

/// The same articulation, ground and controller with Bullet's multibody dynamics, collision
/// detection and contact solver (double precision, two friction directions): the engine of the
/// paper, and what ours is held against.
/// Each body's inertia must be principal along its shape's axes about the shape's centre, as
/// HumanoidModel makes them; a rigid joint stands unrotated.
/// Threads: one caller at a time.
class BulletEngine {
 public:
  /// Refers to `tree`, which must outlive it.
  BulletEngine(const Articulation& tree, const StepSettings& settings);
  ~BulletEngine();

  /// Places the bodies; contacts are forgotten.
  void Reset(const StepState& state);
  /// The controller's forces, then the substeps. `state` must be the last step's.
  void Step(const StepDrive& drive, StepState& state, StepEffort& effort);
  /// The substeps alone, with these forces (speeds; at the root a wrench in world axes) held.
  void Advance(const double* forces, StepState& state);

  /// Accelerations that these forces give without contacts, by Bullet's articulated-body algorithm.
  Speeds FreeAcceleration(const State& state, const Speeds& forces);

 private:
  struct World;
  void AddForces(const double* forces);
  void ReadState(StepState& state) const;
  void ReadContacts(StepState& state) const;

  const Articulation& tree_;
  StepSettings settings_;
  std::unique_ptr<World> world_;
};

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_BULLET_ENGINE_H_
