#include "core/learning/rl/running_moments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace poise::rl {
namespace {

constexpr int kRows = 1000;

// Two columns: one far from 0 with a small spread, which one-pass sums of squares lose, one plain.
std::vector<float> MakeRows() {
  base::Random random(3);
  std::vector<float> rows;
  for (int i = 0; i < kRows; ++i) {
    rows.push_back(static_cast<float>(10000 + 0.5 * random.Normal()));
    rows.push_back(static_cast<float>(random.Normal()));
  }
  return rows;
}

TEST(RunningMomentsTest, EqualTwoPassesOverAllRows) {
  const std::vector<float> rows = MakeRows();
  RunningMoments moments(2);
  // In pieces of different sizes, also none.
  size_t begin = 0;
  for (const size_t count : {1, 7, 0, 500, 492}) {
    moments.Add(std::span(rows).subspan(begin, 2 * count));
    begin += 2 * count;
  }
  ASSERT_EQ(begin, rows.size());
  EXPECT_EQ(moments.count, kRows);
  for (int d = 0; d < 2; ++d) {
    double mean = 0, squares = 0;
    for (int i = 0; i < kRows; ++i) mean += rows[2 * i + d] / double{kRows};
    for (int i = 0; i < kRows; ++i) squares += std::pow(rows[2 * i + d] - mean, 2);
    EXPECT_NEAR(moments.mean[d], mean, 1e-12 * std::abs(mean) + 1e-12);
    EXPECT_NEAR(moments.Deviation(d, 0), std::sqrt(squares / kRows), 1e-9);
  }
}

TEST(RunningMomentsTest, HoldTheDeviationAboveItsFloor) {
  RunningMoments moments(1);
  EXPECT_EQ(moments.Deviation(0, 0.02), 1) << "before anything was added";
  moments.Add(std::vector<float>{5, 5, 5});
  EXPECT_EQ(moments.Deviation(0, 0.02), 0.02);
}

TEST(ObservationScaleTest, GivesMeanZeroDeviationOneAndClips) {
  const std::vector<float> rows = MakeRows();
  RunningMoments moments(2);
  moments.Add(rows);
  std::vector<float> scaled(rows.size());
  ObservationScale::FromMoments(moments, 0.02, 0).Apply(rows, scaled);
  RunningMoments after(2);
  after.Add(scaled);
  for (int d = 0; d < 2; ++d) {
    EXPECT_NEAR(after.mean[d], 0, 1e-4);
    EXPECT_NEAR(after.Deviation(d, 0), 1, 1e-3);
  }
  ObservationScale::FromMoments(moments, 0.02, 1.5).Apply(rows, scaled);
  float largest = 0;
  for (const float value : scaled) largest = std::max(largest, std::abs(value));
  EXPECT_EQ(largest, 1.5F);
}

}  // namespace
}  // namespace poise::rl
