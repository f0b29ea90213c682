#ifndef POISE_CORE_PUSH_GROUND_FRAME_H_
#define POISE_CORE_PUSH_GROUND_FRAME_H_

#include "core/math/rotation.h"

/// Pushes are forecast in a ground frame: X forward (in the data: along the push), Y to the left,
/// Z up. Elsewhere the world has Y up; X is the same in both.
namespace poise::push {

using math::Vec3;

inline Vec3 GroundFromWorld(const Vec3& world) { return {world.x(), -world.z(), world.y()}; }
inline Vec3 WorldFromGround(const Vec3& ground) { return {ground.x(), ground.z(), -ground.y()}; }

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_GROUND_FRAME_H_
