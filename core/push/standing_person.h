#ifndef POISE_CORE_PUSH_STANDING_PERSON_H_
#define POISE_CORE_PUSH_STANDING_PERSON_H_

#include "core/motion/clip.h"

namespace poise::push {

/// One frame of a person who stands upright with hanging arms, faces +X, and has the 22 joints of
/// the push models: the mean of the recorded people before their push, made symmetric. Its rest
/// pose is this pose. Pelvis above the origin.
const motion::Clip& StandingPerson();

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_STANDING_PERSON_H_
