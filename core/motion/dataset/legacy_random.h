#ifndef POISE_CORE_MOTION_DATASET_LEGACY_RANDOM_H_
#define POISE_CORE_MOTION_DATASET_LEGACY_RANDOM_H_

#include <cstdint>
#include <random>

namespace poise::motion {

/// numpy.random.RandomState of a seed, as far as published test windows need it. For everything
/// else there is base::Random.
/// Source: reference sec. 1.7.
class LegacyRandom {
 public:
  explicit LegacyRandom(uint32_t seed) : engine_(seed) {}

  uint32_t Next() { return static_cast<uint32_t>(engine_()); }

  /// randint(low, high): uniform over low .. high - 1, by masked rejection with one 32-bit draw a
  /// try (std::uniform_int_distribution draws others). A range of one value draws nothing.
  /// Precondition: low < high.
  int Integer(int low, int high);

 private:
  std::mt19937 engine_;
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_LEGACY_RANDOM_H_
