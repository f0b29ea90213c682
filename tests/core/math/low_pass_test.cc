#include "core/math/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace poise::math {
namespace {

std::vector<double> Wave(double hz, double rate_hz, int count) {
  std::vector<double> wave;
  for (int i = 0; i < count; ++i) wave.push_back(std::sin(2 * std::numbers::pi * hz * i / rate_hz));
  return wave;
}

TEST(LowPassTest, LinesPassUnchanged) {
  std::vector<double> line;
  for (int i = 0; i < 200; ++i) line.push_back(3 + 0.5 * i);
  std::vector<double> filtered = line;
  LowPassZeroPhase(filtered, 120, 6);
  for (int i = 0; i < 200; ++i) EXPECT_NEAR(filtered[i], line[i], 1e-3);
}

TEST(LowPassTest, HalvesTheCutoffWithoutDelayAndKeepsWhatIsSlow) {
  for (const auto& [hz, gain] : {std::pair(6.0, 0.5), std::pair(0.6, 1.0), std::pair(40.0, 0.0)}) {
    const std::vector<double> wave = Wave(hz, 120, 600);
    std::vector<double> filtered = wave;
    LowPassZeroPhase(filtered, 120, 6);
    for (int i = 200; i < 400; ++i) EXPECT_NEAR(filtered[i], gain * wave[i], 2e-3) << hz << " Hz";
  }
}

TEST(LowPassTest, TakesAnyLength) {
  for (int size = 0; size < 6; ++size) {
    std::vector<double> values(size, 2.0);
    LowPassZeroPhase(values, 120, 6);
    for (const double value : values) EXPECT_NEAR(value, 2, 1e-12);
  }
}

}  // namespace
}  // namespace poise::math
