#ifndef POISE_CORE_MATH_SLERP_H_
#define POISE_CORE_MATH_SLERP_H_

#include <array>

#include "core/math/rotation.h"

namespace poise::math {

/// Shortest-path spherical interpolation at one u in [0, 1], for any number of pairs: what depends
/// on u alone is worked out once. u = 0 gives a and u = 1 gives b, exactly.
/// Between rotations less than 23 degrees apart, as neighbouring frames are, it needs neither a
/// sine nor an arc cosine: exact to rounding, and several times faster.
class SlerpAt {
 public:
  explicit SlerpAt(double u);

  Quat operator()(const Quat& a, const Quat& b) const {
    const double dot = a.dot(b);
    const double z = (1 - std::abs(dot)) / 2;
    if (z > kLargestZ || at_end_) return Exact(a, b);
    Eigen::Array2d weights = series_[kTerms - 1];
    for (int term = kTerms - 2; term >= 0; --term) weights = weights * z + series_[term];
    const double weight_b = dot < 0 ? -weights[1] : weights[1];
    Quat result;
    result.coeffs() = weights[0] * a.coeffs() + weight_b * b.coeffs();
    return result;
  }

 private:
  // The first term left out is less than kLargestZ^kTerms = 1e-16 of the sum.
  static constexpr int kTerms = 8;
  static constexpr double kLargestZ = 0.01;

  Quat Exact(const Quat& a, const Quat& b) const;

  double u_;
  bool at_end_;
  std::array<Eigen::Array2d, kTerms> series_;  // of a's weight and b's
};

/// One pair.
inline Quat Slerp(const Quat& a, const Quat& b, double u) { return SlerpAt(u)(a, b); }

}  // namespace poise::math

#endif  // POISE_CORE_MATH_SLERP_H_
