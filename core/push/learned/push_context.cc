#include "core/push/learned/push_context.h"

namespace poise::push {

std::array<float, kContextSize> ContextOf(const PersonFacts& facts) {
  constexpr int kLongPush = 8;       // [frames] recorded short pushes end before
  constexpr double kLongest = 20;    // [frames]
  constexpr double kUsualMass = 80;  // [kg]
  const double pushed = facts.pushed ? 1 : 0;
  return {static_cast<float>(pushed),
          static_cast<float>(pushed * facts.impulse_ns / facts.mass_kg),
          static_cast<float>(pushed * facts.push_frames / kLongest),
          static_cast<float>(pushed * (facts.push_frames >= kLongPush)),
          facts.alone ? 1.0f : 0.0f,
          static_cast<float>(facts.mass_kg / kUsualMass - 1),
          static_cast<float>(kLeanScale * facts.theta),
          static_cast<float>(kLeanScale * facts.phi)};
}

}  // namespace poise::push
