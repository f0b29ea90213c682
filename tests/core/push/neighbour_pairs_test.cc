#include "core/push/interaction/neighbour_pairs.h"

#include <gmock/gmock.h>

#include "core/base/random.h"

namespace poise::push {
namespace {

TEST(NeighbourPairsTest, FindsWhatComparingAllWithAllFinds) {
  base::Random random(1);
  NeighbourPairs neighbours;
  for (const int people : {1, 2, 50, 400}) {
    Eigen::ArrayX2d places(people, 2);
    for (double& value : places.reshaped()) value = random.Uniform(-4, 4);
    std::vector<std::pair<int, int>> expected, found;
    for (int i = 0; i < people; ++i) {
      for (int j = i + 1; j < people; ++j) {
        if ((places.row(i) - places.row(j)).matrix().norm() <= 0.7) expected.emplace_back(i, j);
      }
    }
    for (const Pair& pair : neighbours.Find(places, 0.7)) {
      found.emplace_back(pair.first, pair.second);
    }
    EXPECT_EQ(found, expected) << people;
  }
}

}  // namespace
}  // namespace poise::push
