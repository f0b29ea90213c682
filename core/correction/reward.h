#ifndef POISE_CORE_CORRECTION_REWARD_H_
#define POISE_CORE_CORRECTION_REWARD_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/physics/humanoid_model.h"
#include "core/physics/state.h"

namespace poise::correction {

using math::Quat;
using math::Vec3;

/// Weights and scales of the imitation reward (MotionAug sec. 4.10). Each term is exp(-scale *
/// error); the imitation reward is their mean by weight, and the total
/// (1 - residual_weight) * imitation + residual_weight * residual term.
/// Defaults are the preset `motionaug`.
struct RewardConfig {
  double pose_weight = 0.5;  ///< [>= 0] squared angles of all joints, by joint weight [rad2]
  double pose_scale = 2;
  double velocity_weight = 0.2;  ///< [>= 0] squared joint speeds, by joint weight [rad2/s2]
  double velocity_scale = 0.005;
  double end_effector_weight = 0.2;  ///< [>= 0] squared distances of feet and hands [m2]
  double end_effector_scale = 5;
  bool end_effector_sum = false;  ///< sum over the four instead of the mean
  double root_weight = 0;         ///< [>= 0] position, rotation and velocities of the root
  double root_scale = 5;
  double center_weight = 0.1;  ///< [>= 0] of the centre of mass
  double center_scale = 100;
  bool center_by_position = false;  ///< squared distance [m2], instead of a tenth of the squared
                                    ///< difference of velocities [m2/s2]
  double residual_weight = 0.1;     ///< [0, 1]
  double residual_scale = 0.01;     ///< of the norm of the wrench [N, N m], or of its square
  bool residual_squared = false;

  /// motionaug: the authors' program | rfc: Residual Force Control, world frame, implicit |
  /// deepmimic: no residual term. Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<RewardConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

/// Turn about the vertical that takes a root's heading to the world's X axis: into the frame of the
/// heading. Of a root's X axis, or its Z axis where that points up.
Quat HeadingInverse(const Quat& root);

/// What a state shows of itself to the reward; of a reference computed once.
struct Features {
  physics::State state;
  physics::BodyFrames frames;
  Vec3 center = Vec3::Zero();           ///< [m] centre of mass
  Vec3 center_velocity = Vec3::Zero();  ///< [m/s]
  /// Feet and hands: horizontally from the root in the heading's frame, vertically above ground.
  std::array<Vec3, 4> end_effectors;
};

Features ComputeFeatures(const physics::HumanoidModel& model, const physics::State& state);

/// Terms from 0 to 1, 1 for equal motion and no wrench.
struct Reward {
  double pose = 0, velocity = 0, end_effector = 0, root = 0, center = 0;
  double imitation = 0;
  double residual = 0;
  double total = 0;
};

/// `force` and `torque` are the outer wrench on the root [N, N m].
Reward ComputeReward(const physics::HumanoidModel& model, const RewardConfig& config,
                     const Features& simulated, const Features& reference, const Vec3& force,
                     const Vec3& torque);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_REWARD_H_
