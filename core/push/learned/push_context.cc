#include "core/push/learned/push_context.h"

#include <algorithm>

namespace poise::push {

float MassFeature(double mass_kg) {
  constexpr double kLeast = 40, kMost = 140, kUsual = 80;  // [kg]
  return static_cast<float>(std::clamp(mass_kg, kLeast, kMost) / kUsual - 1);
}

std::array<float, kContextSize> ContextOf(const PersonFacts& facts) {
  constexpr int kLongPush = 8;     // [frames] recorded short pushes end before
  constexpr double kLongest = 20;  // [frames]
  // What lies far outside the recordings counts as their border.
  constexpr double kMostFrames = 25;
  const double frames = std::min<double>(facts.push_frames, kMostFrames);
  const double pushed = facts.pushed ? 1 : 0;
  return {static_cast<float>(pushed),
          static_cast<float>(pushed * facts.impulse_ns / facts.mass_kg),
          static_cast<float>(pushed * frames / kLongest),
          static_cast<float>(pushed * (facts.push_frames >= kLongPush)),
          facts.alone ? 1.0f : 0.0f,
          MassFeature(facts.mass_kg),
          static_cast<float>(kLeanScale * facts.theta),
          static_cast<float>(kLeanScale * facts.phi)};
}

}  // namespace poise::push
