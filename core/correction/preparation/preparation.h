#ifndef POISE_CORE_CORRECTION_PREPARATION_PREPARATION_H_
#define POISE_CORE_CORRECTION_PREPARATION_PREPARATION_H_

#include "core/correction/preparation/preparation_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Makes a motion fit to be imitated: the body on the floor y = 0 (body_height.h), limbs that do
/// not run through each other (limb_separation.h), feet that stay where they stand (foot_plant.h).
/// `clip` has the character's joints; a clean motion comes back nearly as it was.
motion::Clip PrepareMotion(const motion::Clip& clip, const physics::HumanoidModel& model,
                           const PreparationConfig& config);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_PREPARATION_H_
