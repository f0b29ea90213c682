#ifndef POISE_CORE_CORRECTION_IMITATION_IMITATION_CONFIG_H_
#define POISE_CORE_CORRECTION_IMITATION_IMITATION_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/learning/rl/ppo_config.h"

namespace poise::correction {

inline constexpr double kTorqueUnit = 100;  ///< [N m] of ImitationConfig::torque_weight

/// How a policy learns to imitate the variants of one clip, on top of the controller without
/// learning (effort `full`). Defaults are the preset `recommended`.
struct ImitationConfig {
  // What the policy does.
  double control_hz = 30;  ///< [Hz, > 0] rounded so that an action is held for whole frames
  /// Outer wrench on the pelvis: none | pd (MotionAug's) | pd_scaled (the policy may lower its
  /// gains, never raise them) | rfc (learned: Residual Force Control) | pd_rfc (pd + learned)
  std::string residual = "pd_scaled";
  double joint_scale = 1;      ///< [rad, > 0] turn of a joint's target per unit of action
  double force_scale = 400;    ///< [N, > 0] asked of the stance legs, per unit; body of 45 kg
  double torque_scale = 100;   ///< [N m, > 0]
  double residual_scale = 3;   ///< [> 0] change of the PD-residual's factor per unit
  double learned_scale = 100;  ///< [N, N m, > 0] learned outer wrench per unit (MotionAug 4.8)
  double look_ahead_s = 0.1;   ///< [s, >= 0] how far the policy sees the reference's next pose

  // What it earns, per action: the imitation reward less the outer wrench.
  bool residual_term = false;  ///< with the reward's own residual term (reward.residual_weight)
  double force_weight = 0.5;   ///< [>= 0] per body weight of outer force
  double torque_weight = 0.2;  ///< [>= 0] per 100 N m of outer torque
  double start_share = 0.25;   ///< [0 to 1] episodes from t = 0; others start at random frames

  // How long it learns.
  int64_t max_samples = 2'000'000;  ///< [>= 1] actions
  double max_seconds = 300;         ///< [s, > 0] of wall time, over all attempts; best so far then
  int evaluate_every = 10;          ///< [>= 1] iterations between evaluations without noise
  int held_out = 8;                 ///< [>= 1] variants that are only evaluated
  int patience = 20;                ///< [>= 0] evaluations without a gain that end it; 0 = never
  double least_gain = 1e-3;         ///< [>= 0] in merit, what counts as a gain
  int environments = 8;             ///< [>= 1] worlds that a batch comes from
  rl::PpoConfig ppo;

  /// `paper`: the authors' networks, optimiser, exploration and reward (MotionAug sec. 4.10, 4.11)
  /// for PPO from the zero policy; give it to a Corrector of the preset `paper`.
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<ImitationConfig> FromPreset(std::string_view preset);

  /// Nested names: "ppo.noise", "ppo.actor.learning_rate".
  std::vector<base::Field> Fields();
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE, MALFORMED_CONFIG_VALUE, with the field.
  Status Validate() const;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_IMITATION_CONFIG_H_
