#ifndef POISE_CORE_PUSH_INTERACTION_BODY_CONTACT_H_
#define POISE_CORE_PUSH_INTERACTION_BODY_CONTACT_H_

#include <Eigen/Core>
#include <vector>

#include "core/push/interaction/neighbour_pairs.h"
#include "core/push/pendulum/physics_config.h"

namespace poise::push {

/// Horizontal forces between people at their hips: trunks that press into each other push apart,
/// and arms brake those who near each other within reach. Equal and opposite, so that they keep
/// momentum; nothing between people who stand still, however close. Differs from the paper's forces
/// (reference sec. 5), which depend on the feet and are not equal and opposite.
class BodyContact {
 public:
  /// Pairs that stand closer than two radii keep that distance as their own.
  BodyContact(const PhysicsConfig& config, const Eigen::ArrayX2d& hips);

  /// Adds the forces [N] on each person. Shapes: hips, velocities, force (people, 2).
  void AddForces(const std::vector<Pair>& pairs, const Eigen::ArrayX2d& hips,
                 const Eigen::ArrayX2d& velocities, Eigen::ArrayX2d& force) const;

  /// Distance [m] beyond which nobody feels another.
  double range() const;

 private:
  double RestDistance(const Pair& pair) const;

  PhysicsConfig config_;
  std::vector<Pair> close_;       // pairs that begin closer than two radii, in order
  std::vector<double> distance_;  // theirs
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_INTERACTION_BODY_CONTACT_H_
