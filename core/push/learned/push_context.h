#ifndef POISE_CORE_PUSH_LEARNED_PUSH_CONTEXT_H_
#define POISE_CORE_PUSH_LEARNED_PUSH_CONTEXT_H_

#include <array>

#include "core/push/learned/hip_config.h"
#include "core/push/pendulum/pendulum.h"

namespace poise::push {

/// What a person is told about itself and, when it is pushed, about the push.
struct PersonFacts {
  bool pushed = false;
  double impulse_ns = 0;  ///< forward, of the push
  int push_frames = 0;
  bool alone = false;
  double mass_kg = 0;
  double theta = 0;  ///< lean in frame 0 [rad]
  double phi = 0;
};

/// A person's mass as networks see it; what lies far outside the recordings counts as their border.
float MassFeature(double mass_kg);

std::array<float, kContextSize> ContextOf(const PersonFacts& facts);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_LEARNED_PUSH_CONTEXT_H_
