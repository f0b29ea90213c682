#include "core/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace poise::base {
namespace {

TEST(RandomTest, TheSameSeedGivesTheSameStream) {
  Random a(7), b(7), c(8);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.Uniform(), b.Uniform());
  EXPECT_NE(a.Uniform(), c.Uniform());
}

TEST(RandomTest, EveryCoordinateOfADerivedSeedMatters) {
  std::set<uint64_t> seeds;
  for (uint64_t source = 0; source < 50; ++source) {
    for (uint64_t variant = 0; variant < 50; ++variant) {
      seeds.insert(DeriveSeed(1, {source, variant}));
    }
  }
  EXPECT_EQ(seeds.size(), 2500u);
  EXPECT_NE(DeriveSeed(1, {2, 3}), DeriveSeed(1, {3, 2}));
  EXPECT_NE(DeriveSeed(1, {}), DeriveSeed(2, {}));
}

TEST(RandomTest, UniformHasTheMomentsOfTheUnitInterval) {
  Random random(3);
  double sum = 0, squares = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    squares += x * x;
  }
  // Four standard errors: 4 * sqrt(1/12 / n) and 4 * sqrt(4/45 / n).
  EXPECT_NEAR(sum / kDraws, 0.5, 4 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / kDraws));
}

TEST(RandomTest, NormalHasMeanZeroVarianceOneAndNoSkew) {
  Random random(4);
  double sum = 0, squares = 0, cubes = 0;
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    squares += x * x;
    cubes += x * x * x;
  }
  // Four standard errors; the variances of x, x^2 and x^3 are 1, 2 and 15.
  EXPECT_NEAR(sum / kDraws, 0, 4 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1, 4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(cubes / kDraws, 0, 4 * std::sqrt(15.0 / kDraws));
}

TEST(RandomTest, IndexReachesEveryValueEquallyOften) {
  Random random(5);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts[random.Index(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 4 * std::sqrt(10000.0));
}

}  // namespace
}  // namespace poise::base
