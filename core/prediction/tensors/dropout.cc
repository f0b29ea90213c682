#include "core/prediction/tensors/dropout.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace poise::prediction {
namespace {

constexpr int kDraws = 4;  // 16 bits each of one random word
constexpr double kSteps = 65536;

// SplitMix64 (Steele, Lea and Flood 2014): words that depend on nothing but their number.
uint64_t Word(uint64_t seed, uint64_t number) {
  uint64_t z = seed + (number + 1) * 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

torch::Tensor Dropout(const torch::Tensor& x, double share, bool training) {
  if (!training || share <= 0) return x;
  const auto least = static_cast<uint32_t>(std::lround(share * kSteps));
  const auto kept = static_cast<float>(kSteps / (kSteps - least));
  const auto seed = static_cast<uint64_t>(
      torch::randint(std::numeric_limits<int64_t>::max(), {1}, torch::kInt64).item<int64_t>());
  torch::Tensor mask = torch::empty(x.sizes());
  float* value = mask.data_ptr<float>();
  const int64_t count = mask.numel();
  for (int64_t i = 0; i < count; i += kDraws) {
    const uint64_t word = Word(seed, static_cast<uint64_t>(i));
    for (int64_t j = 0; j < kDraws && i + j < count; ++j) {
      value[i + j] = ((word >> (16 * j)) & 0xffff) >= least ? kept : 0.0F;
    }
  }
  return x * mask;
}

}  // namespace poise::prediction
