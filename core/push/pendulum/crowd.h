#ifndef POISE_CORE_PUSH_PENDULUM_CROWD_H_
#define POISE_CORE_PUSH_PENDULUM_CROWD_H_

#include "core/push/interaction/body_contact.h"
#include "core/push/interaction/neighbour_pairs.h"
#include "core/push/pendulum/pendulum.h"
#include "core/push/pendulum/physics_config.h"
#include "core/push/push_scene.h"

namespace poise::push {

/// The pendulums of everybody in a scene, stepped frame by frame under pushes, balance and contact.
/// People who nobody touches stand still exactly. The same scene gives the same numbers.
/// Memory does not grow with the number of frames. Threads: one caller at a time.
class Crowd {
 public:
  Crowd(const PushScene& scene, const PhysicsConfig& config);

  /// Goes from one frame to the next under `push` (people, 4), the generalised forces from outside
  /// during that frame.
  void Step(const PendulumArray& push);

  const PendulumStates& states() const { return states_; }
  const PendulumBodies& bodies() const { return bodies_; }
  /// Generalised forces between people, mean over the last frame.
  const PendulumArray& interaction() const { return interaction_; }
  /// Horizontal forces of the floor, mean over the last frame: (people, 2) [N].
  const Eigen::ArrayX2d& floor_force() const { return floor_force_; }
  Eigen::ArrayX3d hips() const { return RodEnds(states_, bodies_.cart_height); }

 private:
  PendulumArray BalanceForces() const;

  PhysicsConfig config_;
  PendulumBodies bodies_;
  PendulumStates states_;
  PendulumArray standing_;  // where each person stands still
  PendulumArray hold_;      // generalised forces that keep it there against gravity
  BodyContact contact_;
  NeighbourPairs neighbours_;
  PendulumArray interaction_;
  Eigen::ArrayX2d floor_force_;
};

/// The generalised forces of a scene's pushes in one frame, on people in these states.
PendulumArray PushForces(const PushScene& scene, int frame, const PendulumStates& states);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PENDULUM_CROWD_H_
