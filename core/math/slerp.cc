#include "core/math/slerp.h"

namespace poise::math {

// With t the angle between the quaternions, their weights are sin((1 - u) t) / sin t and
// sin(u t) / sin t. Each is a Chebyshev function of the second kind, and so a Gauss series in
// z = (1 - cos t) / 2:
//   sin(v t) / sin t = v F(1 - v, 1 + v; 3/2; z)
// whose terms shrink faster than the powers of z.
SlerpAt::SlerpAt(double u) : u_(u), at_end_(!(u > 0 && u < 1)) {
  const Eigen::Array2d v(1 - u, u);
  series_[0] = v;
  for (int term = 1; term < kTerms; ++term) {
    series_[term] = series_[term - 1] * (term * term - v * v) / (term * (term + 0.5));
  }
}

Quat SlerpAt::Exact(const Quat& a, const Quat& b) const {
  if (u_ <= 0) return a;
  if (u_ >= 1) return b;
  return a.slerp(u_, b);
}

}  // namespace poise::math
