#ifndef POISE_CORE_BASE_RANDOM_H_
#define POISE_CORE_BASE_RANDOM_H_

#include <cstdint>
#include <initializer_list>
#include <random>

namespace poise::base {

/// Mixes a seed with the coordinates of a piece of work (source, variant, step) into a new seed, so
/// that each piece draws from its own stream, whatever thread runs it and in whatever order.
uint64_t DeriveSeed(uint64_t seed, std::initializer_list<uint64_t> coordinates);

/// A stream of random numbers that is the same for the same seed on every machine (the
/// distributions of the standard library are not).
/// Threads: one caller at a time.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1).
  double Uniform();
  /// Uniform in [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// Standard normal (Box-Muller).
  double Normal();
  /// Uniform over 0 .. count - 1; count > 0.
  uint64_t Index(uint64_t count);

 private:
  std::mt19937_64 engine_;
};

}  // namespace poise::base

#endif  // POISE_CORE_BASE_RANDOM_H_
