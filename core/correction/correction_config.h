#ifndef POISE_CORE_CORRECTION_CORRECTION_CONFIG_H_
#define POISE_CORE_CORRECTION_CORRECTION_CONFIG_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/correction/reference_motion.h"
#include "core/correction/reward.h"
#include "core/correction/tracking/iterative_learning.h"
#include "core/correction/tracking/tracking_config.h"
#include "core/physics/humanoid_config.h"
#include "core/physics/world_config.h"

namespace poise::correction {

/// All that decides how a motion is corrected. Field names are nested: "humanoid.body_mass_kg",
/// "world.rate_hz", "reference.floor", "tracking.residual_factor", "reward.pose_weight",
/// "learning.rollouts".
struct CorrectionConfig {
  /// instant: the controller without learning | fast: iterative learning on top of it
  std::string effort = "fast";
  physics::HumanoidConfig humanoid;
  physics::WorldConfig world;
  ReferenceConfig reference;
  TrackingConfig tracking;
  RewardConfig reward;
  LearningConfig learning;

  /// `recommended`, or `paper`: the authors' character, engine, rates and zero policy, `instant`.
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<CorrectionConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_CORRECTION_CONFIG_H_
