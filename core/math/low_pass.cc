#include "core/math/low_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace poise::math {
namespace {

struct Biquad {
  double b0, b1, b2, a1, a2;
};

// Bilinear transform with the cutoff pre-warped.
Biquad Butterworth(double rate_hz, double cutoff_hz) {
  const double k = std::tan(std::numbers::pi * cutoff_hz / rate_hz);
  const double scale = 1 / (1 + std::numbers::sqrt2 * k + k * k);
  return {.b0 = k * k * scale,
          .b1 = 2 * k * k * scale,
          .b2 = k * k * scale,
          .a1 = 2 * (k * k - 1) * scale,
          .a2 = (1 - std::numbers::sqrt2 * k + k * k) * scale};
}

// Starts as if the first value had always been there.
template <typename Iterator>
void Run(const Biquad& f, Iterator first, Iterator last) {
  double x1 = *first, x2 = *first, y1 = *first, y2 = *first;
  for (Iterator it = first; it != last; ++it) {
    const double x = *it, y = f.b0 * x + f.b1 * x1 + f.b2 * x2 - f.a1 * y1 - f.a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    *it = y;
  }
}

}  // namespace

void LowPassZeroPhase(std::span<double> values, double rate_hz, double cutoff_hz) {
  if (values.size() < 2 || cutoff_hz >= rate_hz / 2) return;
  const Biquad filter = Butterworth(rate_hz, cutoff_hz);
  const auto settle = static_cast<size_t>(std::ceil(3 * rate_hz / cutoff_hz));
  const size_t size = values.size(), pad = std::min(settle, size - 1);
  std::vector<double> padded(size + 2 * pad);
  for (size_t i = 0; i < pad; ++i) {
    padded[i] = 2 * values.front() - values[pad - i];
    padded[pad + size + i] = 2 * values.back() - values[size - 2 - i];
  }
  std::copy(values.begin(), values.end(), padded.begin() + static_cast<ptrdiff_t>(pad));
  Run(filter, padded.begin(), padded.end());
  Run(filter, padded.rbegin(), padded.rend());
  std::copy_n(padded.begin() + static_cast<ptrdiff_t>(pad), size, values.begin());
}

}  // namespace poise::math
