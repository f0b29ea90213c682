#ifndef POISE_CORE_PUSH_RESTORATION_PLANTED_FEET_H_
#define POISE_CORE_PUSH_RESTORATION_PLANTED_FEET_H_

#include <array>

#include "core/push/restoration/rigid_fit.h"

namespace poise::push {

/// Bends both legs so that the toes (right, left) come to `toes`, from the pelvis [m], in closed
/// form: knees keep their side, feet their direction; a heel rises when the leg is else too short.
/// A toe that is out of reach even then comes as near as the leg allows. Bones keep their lengths.
/// `turns` are those of the body whose bones are `first`; only the legs' change.
void PlantFeet(const BodyShape& first, const std::array<Vec3, 2>& toes, BodyTurns& turns);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_RESTORATION_PLANTED_FEET_H_
