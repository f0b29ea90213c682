#ifndef POISE_CORE_LEARNING_RL_RUNNING_MOMENTS_H_
#define POISE_CORE_LEARNING_RL_RUNNING_MOMENTS_H_

#include <cstdint>
#include <span>
#include <vector>

namespace poise::rl {

/// Mean and variance per dimension of all rows seen, in one pass (Chan, Golub and LeVeque 1983).
struct RunningMoments {
  int64_t count = 0;
  std::vector<double> mean;     // (dimensions)
  std::vector<double> squares;  // (dimensions) sum of squared differences to the mean

  explicit RunningMoments(int dimensions) : mean(dimensions), squares(dimensions) {}

  int dimensions() const { return static_cast<int>(mean.size()); }

  /// rows: (any number, dimensions). Their order and their division into calls changes the
  /// result by rounding only.
  void Add(std::span<const float> rows);

  /// Of the whole population, not less than `floor`; 1 before anything was added.
  double Deviation(int dimension, double floor) const;
};

/// The affine map that gives observations mean 0 and deviation 1, frozen. The default leaves them.
struct ObservationScale {
  std::vector<float> mean;               // (dimensions)
  std::vector<float> inverse_deviation;  // (dimensions)
  float limit = 0;                       ///< results are clipped to +- this; 0 = off

  static ObservationScale FromMoments(const RunningMoments& moments, double deviation_min,
                                      double limit);

  /// Shapes: rows, scaled (any number, dimensions); they may be the same memory.
  void Apply(std::span<const float> rows, std::span<float> scaled) const;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_RUNNING_MOMENTS_H_
