#include "bench/stream_kernel.h"

#include "core/learning/rl/kernel/vector.h"

namespace poise::bench::POISE_KERNEL_ISA {

float StreamKernel(const float* numbers, long count) {
  using rl::POISE_KERNEL_ISA::kLanes, rl::POISE_KERNEL_ISA::Load, rl::POISE_KERNEL_ISA::Vector;
  constexpr int kSums = 8, kAhead = 1024, kLine = 16;
  Vector sums[kSums] = {};
  for (long i = 0; i < count; i += kSums * kLanes) {
    for (int k = 0; k < kSums * kLanes; k += kLine) __builtin_prefetch(numbers + i + k + kAhead);
    for (int k = 0; k < kSums; ++k) sums[k] += Load(numbers + i + k * kLanes);
  }
  float sum = 0;
  for (const Vector& part : sums) {
    for (int lane = 0; lane < kLanes; ++lane) sum += part[lane];
  }
  return sum;
}

}  // namespace poise::bench::POISE_KERNEL_ISA
