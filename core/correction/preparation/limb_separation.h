#ifndef POISE_CORE_CORRECTION_PREPARATION_LIMB_SEPARATION_H_
#define POISE_CORE_CORRECTION_PREPARATION_LIMB_SEPARATION_H_

#include "core/correction/preparation/preparation_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Turns hips and shoulders a little, smoothly in time, where bodies overlap that must not (legs
/// that cross through each other, a hand in a thigh). What little remains the simulation's
/// self-collision keeps apart.
motion::Clip SeparateLimbs(motion::Clip clip, const physics::HumanoidModel& model,
                           const PreparationConfig& config);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_LIMB_SEPARATION_H_
