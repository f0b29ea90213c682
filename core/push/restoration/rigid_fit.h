#ifndef POISE_CORE_PUSH_RESTORATION_RIGID_FIT_H_
#define POISE_CORE_PUSH_RESTORATION_RIGID_FIT_H_

#include <array>
#include <span>

#include "core/push/body_joints.h"
#include "core/push/ground_frame.h"

namespace poise::push {

/// A body's joints from the pelvis [m].
using BodyShape = std::array<Vec3, kBodyJoints>;
/// How each joint is turned in the world since frame 0.
using BodyTurns = std::array<math::Quat, kBodyJoints>;

/// The turns that bring the body of frame 0 nearest to `wanted`: joint by joint from the pelvis,
/// the least-squares rotation of its bones; a limb's joint with one bone does not twist about it.
BodyTurns FitTurns(const BodyShape& first, const BodyShape& wanted);

/// Where the joints are then: bones keep their lengths, and joints with several bones their shape.
BodyShape Turned(const BodyShape& first, const BodyTurns& turns);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_RESTORATION_RIGID_FIT_H_
