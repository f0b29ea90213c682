#ifndef POISE_CORE_CORRECTION_DEBIAS_FOOT_HOLD_H_
#define POISE_CORE_CORRECTION_DEBIAS_FOOT_HOLD_H_

#include "core/correction/debias/debias_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Gives the feet back to the imitation where they stand or swing low: the originals slide and
/// sink, which physics has just cured. By two-bone inverse kinematics of the legs, under the
/// debiased pelvis, which stays where the feet do (FootHold::root) and sinks where a leg is too
/// short.
/// Preconditions: both of the same frames, with the character's 16 joints.
motion::Clip HoldFeet(motion::Clip debiased, const motion::Clip& imitated,
                      const physics::HumanoidModel& body, const FootHold& hold);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_DEBIAS_FOOT_HOLD_H_
