#include "core/motion/dataset/column_statistics.h"

#include <gtest/gtest.h>

namespace poise::motion {
namespace {

TEST(ColumnStatisticsTest, MeanAndPopulationDeviationAreThoseOfAllRowsTogether) {
  PoseMatrix first(2, 2), second(1, 2);
  first << 1, 5, 2, 5;
  second << 6, 5;
  const ColumnStatistics statistics = ColumnStatistics::Of({first, second});
  EXPECT_DOUBLE_EQ(statistics.mean[0], 3);
  EXPECT_DOUBLE_EQ(statistics.deviation[0], std::sqrt((4 + 1 + 9) / 3.0));
  EXPECT_EQ(statistics.mean[1], 5);
  EXPECT_EQ(statistics.deviation[1], 0);
  EXPECT_EQ(statistics.moving(), (std::vector<bool>{true, false}));
}

}  // namespace
}  // namespace poise::motion
