#include "core/motion/dataset/legacy_random.h"

#include <bit>

namespace poise::motion {

int LegacyRandom::Integer(int low, int high) {
  const auto range = static_cast<uint32_t>(high - low - 1);
  if (range == 0) return low;
  const uint32_t mask = std::bit_ceil(uint64_t{range} + 1) - 1;
  uint32_t value = Next() & mask;
  while (value > range) value = Next() & mask;
  return low + static_cast<int>(value);
}

}  // namespace poise::motion
