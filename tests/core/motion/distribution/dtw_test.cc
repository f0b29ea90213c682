#include "core/motion/distribution/dtw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace poise::motion {
namespace {

// One column.
FrameFeatures Line(const std::vector<float>& values) {
  return Eigen::Map<const FrameFeatures>(values.data(), static_cast<Eigen::Index>(values.size()),
                                         1);
}

FrameFeatures RandomMotion(Eigen::Index frames, base::Random& random) {
  FrameFeatures motion(frames, 3);
  for (float& value : motion.reshaped()) value = static_cast<float>(random.Normal());
  return motion;
}

// Every way from the first to the last frames, one after the other.
double CheapestWay(const FrameFeatures& a, const FrameFeatures& b, Eigen::Index i, Eigen::Index j) {
  const double here = (a.row(i) - b.row(j)).cast<double>().norm();
  if (i == 0 && j == 0) return here;
  double before = std::numeric_limits<double>::infinity();
  if (i > 0) before = std::min(before, CheapestWay(a, b, i - 1, j));
  if (j > 0) before = std::min(before, CheapestWay(a, b, i, j - 1));
  if (i > 0 && j > 0) before = std::min(before, CheapestWay(a, b, i - 1, j - 1));
  return here + before;
}

TEST(DtwTest, IsTheSumByHand) {
  // 0-0, 2-1, 2-3, 4-4: 0 + 1 + 1 + 0, over four frames.
  EXPECT_DOUBLE_EQ(DtwDistance(Line({0, 2, 4}), Line({0, 1, 3, 4})), 2.0 / 4);
}

TEST(DtwTest, AMotionThatOnlyDwellsIsNoFurther) {
  EXPECT_EQ(DtwDistance(Line({0, 1, 2, 3}), Line({0, 0, 0, 1, 1, 2, 3, 3})), 0);
}

TEST(DtwTest, IsTheCheapestOfAllWays) {
  base::Random random(4);
  for (int i = 0; i < 30; ++i) {
    const FrameFeatures a = RandomMotion(1 + static_cast<int>(random.Index(6)), random);
    const FrameFeatures b = RandomMotion(1 + static_cast<int>(random.Index(6)), random);
    const double cheapest = CheapestWay(a, b, a.rows() - 1, b.rows() - 1) /
                            static_cast<double>(std::max(a.rows(), b.rows()));
    EXPECT_NEAR(DtwDistance(a, b), cheapest, 1e-5);
    EXPECT_DOUBLE_EQ(DtwDistance(a, b), DtwDistance(b, a));
    EXPECT_DOUBLE_EQ(DtwDistance(a, b, cheapest + 0.01), DtwDistance(a, b));
    EXPECT_TRUE(std::isinf(DtwDistance(a, b, cheapest - 0.01)));
  }
}

TEST(DtwTest, TheNearestIsThatOfAllDistances) {
  base::Random random(5);
  std::vector<FrameFeatures> set;
  for (int i = 0; i < 20; ++i) set.push_back(RandomMotion(5 + i % 4, random));
  for (int i = 0; i < 20; ++i) {
    int nearest = i == 0 ? 1 : 0;
    for (int j = 0; j < 20; ++j) {
      if (j != i && DtwDistance(set[i], set[j]) < DtwDistance(set[i], set[nearest])) nearest = j;
    }
    EXPECT_EQ(FindNearest(set[i], set).index, i);
    EXPECT_EQ(FindNearest(set[i], set, i).index, nearest);
    EXPECT_DOUBLE_EQ(FindNearest(set[i], set, i).distance, DtwDistance(set[i], set[nearest]));
  }
  EXPECT_EQ(FindNearest(set[0], {}).index, -1);
}

}  // namespace
}  // namespace poise::motion
