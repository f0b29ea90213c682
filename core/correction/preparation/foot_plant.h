#ifndef POISE_CORE_CORRECTION_PREPARATION_FOOT_PLANT_H_
#define POISE_CORE_CORRECTION_PREPARATION_FOOT_PLANT_H_

#include "core/correction/preparation/preparation_config.h"
#include "core/motion/clip.h"
#include "core/physics/humanoid_model.h"

namespace poise::correction {

/// Lets feet stay where they stand, with flat soles on the floor y = 0, and keeps them above it
/// elsewhere, by two-bone inverse kinematics of the legs.
/// A foot stands where it was on average during that contact; what touches the floor does not
/// slide, while the foot may roll about it. In between a foot comes back to its own way. Where the
/// feet that stand glide together (the whole body drifts), the body follows them instead of the
/// legs; where a leg is too short, the pelvis sinks.
motion::Clip PlantFeet(motion::Clip clip, const physics::HumanoidModel& model,
                       const PreparationConfig& config);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_PREPARATION_FOOT_PLANT_H_
