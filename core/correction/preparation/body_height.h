#ifndef POISE_CORE_CORRECTION_PREPARATION_BODY_HEIGHT_H_
#define POISE_CORE_CORRECTION_PREPARATION_BODY_HEIGHT_H_

#include "core/correction/preparation/preparation_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Lowers a body that floats and raises one that has sunk, also in a part of the clip only: a foot
/// that is still while the body does not fall freely must stand on the floor y = 0. Jumps and
/// strides stay; still feet farther away than height_band_m (stairs) do, too.
motion::Clip StandOnFloor(motion::Clip clip, const physics::HumanoidModel& model,
                          const PreparationConfig& config);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_BODY_HEIGHT_H_
