#include "core/base/random.h"

#include <cmath>
#include <numbers>

namespace poise::base {
namespace {

// Finaliser of SplitMix64 (Steele, Lea and Flood 2014): every input bit reaches every output bit.
uint64_t Mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

uint64_t DeriveSeed(uint64_t seed, std::initializer_list<uint64_t> coordinates) {
  uint64_t state = Mix(seed);
  for (const uint64_t coordinate : coordinates) state = Mix(state ^ Mix(coordinate));
  return state;
}

double Random::Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::Normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * Uniform());
}

uint64_t Random::Index(uint64_t count) {
  // Rejection keeps every index equally likely.
  const uint64_t limit = UINT64_MAX - UINT64_MAX % count;
  uint64_t draw = engine_();
  while (draw >= limit) draw = engine_();
  return draw % count;
}

}  // namespace poise::base
