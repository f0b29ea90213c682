#include "core/math/k_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace poise::math {
namespace {

// Three clouds of ten points, far apart.
Eigen::MatrixXd Clouds() {
  base::Random random(1);
  Eigen::MatrixXd points(30, 2);
  for (int i = 0; i < 30; ++i) {
    points.row(i) << 10 * (i % 3) + random.Normal(), (i % 3 == 1 ? 10 : 0) + random.Normal();
  }
  return points;
}

TEST(KMeansTest, CloudsThatLieApartAreFound) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    base::Random random(seed);
    const std::vector<int> labels = KMeans(Clouds(), 3, random);
    for (int i = 3; i < 30; ++i) EXPECT_EQ(labels[i], labels[i % 3]);
    EXPECT_EQ((std::set<int>{labels[0], labels[1], labels[2]}).size(), 3u);
  }
}

TEST(KMeansTest, TheBestSplitOfALineIsFound) {
  // 0 1 2 | 10 11: the sum of squares is 2 + 0.5; every other split of a line has more.
  Eigen::MatrixXd points(5, 1);
  points << 0, 1, 2, 10, 11;
  base::Random random(7);
  const std::vector<int> labels = KMeans(points, 2, random);
  EXPECT_EQ(labels[0], labels[1]);
  EXPECT_EQ(labels[1], labels[2]);
  EXPECT_NE(labels[2], labels[3]);
  EXPECT_EQ(labels[3], labels[4]);
}

TEST(KMeansTest, FewPointsAndEqualPointsLeaveNoClusterEmpty) {
  base::Random random(1);
  EXPECT_EQ(KMeans(Eigen::MatrixXd::Random(2, 3), 3, random).size(), 2u);
  const std::vector<int> labels = KMeans(Eigen::MatrixXd::Ones(5, 2), 3, random);
  EXPECT_EQ(*std::max_element(labels.begin(), labels.end()) + 1,
            static_cast<int>(std::set<int>(labels.begin(), labels.end()).size()));
  EXPECT_TRUE(KMeans(Eigen::MatrixXd(0, 2), 3, random).empty());
}

TEST(KMeansTest, TheSameSeedGivesTheSameClusters) {
  base::Random a(5), b(5);
  const Eigen::MatrixXd points = Eigen::MatrixXd::Random(40, 4);
  EXPECT_EQ(KMeans(points, 4, a), KMeans(points, 4, b));
}

}  // namespace
}  // namespace poise::math
