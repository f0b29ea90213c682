#ifndef POISE_CORE_PHYSICS_HUMANOID_MODEL_H_
#define POISE_CORE_PHYSICS_HUMANOID_MODEL_H_

#include <array>
#include <memory>

#include "core/motion/body_shapes.h"
#include "core/motion/clip.h"
#include "core/physics/articulation.h"
#include "core/physics/humanoid_config.h"

namespace poise::physics {

using math::Quat;
using math::Vec3;

/// Gains of the PD-residual wrench on the pelvis (MotionAug sec. 4.8).
struct ResidualGains {
  double stiffness = 200;          ///< [N/m]
  double damping = 100;            ///< [N s/m]
  double angular_stiffness = 100;  ///< [N m/rad]
  double angular_damping = 10;     ///< [N m s/rad]

  /// All of them times `factor`; 0 switches the residual off.
  ResidualGains Scaled(double factor) const;
};

/// The simulated character of one skeleton: 16 bodies in the order of the required roles
/// (motion/joint_roles.h), joined by ball joints. Constant and shared.
/// Body i is the role i; its frame is the frame of the joint that plays the role, so a clip that is
/// reduced to the roles (motion/editing/reduce.h, composed) is a sequence of its poses.
/// Source: MotionAug sec. 4.2 and 4.3. We differ: feet are mirror images of each other, and shapes
/// follow the skeleton's own bones.
class HumanoidModel {
 public:
  /// From roles and bone lengths of any biped; `soles` say how its feet stand.
  /// Errors: kFailedPrecondition MISSING_ROLES, UNUSUAL_HIERARCHY (a role's joint does not hang
  /// below that of its parent role); kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE.
  static StatusOr<std::shared_ptr<const HumanoidModel>> Create(const motion::Skeleton& skeleton,
                                                               const motion::JointRoles& roles,
                                                               const motion::Soles& soles,
                                                               const HumanoidConfig& config = {});
  /// The same, with soles averaged over the frames of `clip` in which the feet stand, made
  /// symmetric.
  static StatusOr<std::shared_ptr<const HumanoidModel>> Create(const motion::Clip& clip,
                                                               const motion::JointRoles& roles,
                                                               const HumanoidConfig& config = {});

  const Articulation& articulation() const { return articulation_; }
  const HumanoidConfig& config() const { return config_; }
  /// The bodies' shapes; their joints are those of the skeleton that the model was made from.
  const motion::BodyShapes& shapes() const { return shapes_; }
  /// Weight of each joint in rewards, before normalisation (MotionAug sec. 4.3).
  const std::array<double, kMaxBodies>& joint_weights() const { return joint_weights_; }
  const ResidualGains& residual_gains() const { return residual_gains_; }
  double total_mass() const;       ///< [kg]
  int degrees_of_freedom() const;  ///< 51, or 45 with fixed wrists

 private:
  HumanoidModel() = default;

  Articulation articulation_;
  HumanoidConfig config_;
  motion::BodyShapes shapes_;
  std::array<double, kMaxBodies> joint_weights_{};
  ResidualGains residual_gains_;
};

using HumanoidModelPtr = std::shared_ptr<const HumanoidModel>;

/// The two soles as mirror images: the mean of both, each described against its own toes and its
/// shin at rest. Unchanged where the rest pose says nothing of them (toes and shin in one line).
motion::Soles SymmetricSoles(const motion::Skeleton& skeleton, const motion::JointRoles& roles,
                             const motion::Soles& soles);

}  // namespace poise::physics

#endif  // POISE_CORE_PHYSICS_HUMANOID_MODEL_H_
