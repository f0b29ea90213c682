#ifndef POISE_CORE_LEARNING_RL_KERNEL_VECTOR_H_
#define POISE_CORE_LEARNING_RL_KERNEL_VECTOR_H_

#include "core/learning/rl/kernel/layer_kernel.h"

/// Vectors of floats of the width that this build's instruction set has. Compilers' vector types,
/// not a library: the same function compiled for two instruction sets must not share a name.
namespace poise::rl::POISE_KERNEL_ISA {

inline constexpr int kLanes = kPanelWidth / 2;
typedef float Vector __attribute__((vector_size(4 * kLanes), may_alias));
typedef int IntVector __attribute__((vector_size(4 * kLanes), may_alias));

inline Vector Load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void Store(Vector value, float* to) { *reinterpret_cast<Vector*>(to) = value; }

inline Vector Relu(Vector x) { return x < 0.0f ? Vector{} : x; }

/// tanh |x| = t / (t + 2) with t = exp(2 |x|) - 1 = 2^n (exp(r) - 1) + (2^n - 1), which nowhere
/// subtracts nearly equal numbers. exp(r) - 1 is its Taylor series; |r| <= ln(2) / 2 leaves 1.5e-8.
inline Vector Tanh(Vector x) {
  constexpr float kSaturated = 10;     // tanh is 1 in single precision from 9.02 on
  constexpr float kRound = 0x1.8p23f;  // adding it leaves the integer part in the low bits
  constexpr float kLog2E = 0x1.715476p0f;
  constexpr float kLn2High = 0x1.62ep-1f, kLn2Low = 0x1.0bfbe8p-15f;  // sum: ln 2
  const IntVector sign = reinterpret_cast<IntVector>(x) & static_cast<int>(0x80000000u);
  const Vector magnitude = reinterpret_cast<Vector>(reinterpret_cast<IntVector>(x) & 0x7fffffff);
  const Vector y = 2 * (magnitude > kSaturated ? Vector{} + kSaturated : magnitude);
  const Vector rounded = y * kLog2E + kRound;
  const Vector n = rounded - kRound;
  const Vector r = (y - n * kLn2High) - n * kLn2Low;
  constexpr float kSeries[] = {1.0f / 5040, 1.0f / 720, 1.0f / 120, 1.0f / 24,
                               1.0f / 6,    1.0f / 2,   1.0f};
  Vector series = Vector{} + kSeries[0];
  for (int i = 1; i < 7; ++i) series = series * r + kSeries[i];
  const Vector power =
      reinterpret_cast<Vector>((reinterpret_cast<IntVector>(rounded) << 23) + 0x3f800000);
  const Vector t = power * (series * r) + (power - 1);
  const Vector value = t / (t + 2);
  return reinterpret_cast<Vector>(reinterpret_cast<IntVector>(value) | sign);
}

}  // namespace poise::rl::POISE_KERNEL_ISA

#endif  // POISE_CORE_LEARNING_RL_KERNEL_VECTOR_H_
