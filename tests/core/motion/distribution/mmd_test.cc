#include "core/motion/distribution/mmd.h"

#include <gtest/gtest.h>

#include <cmath>

namespace poise::motion {
namespace {

Eigen::MatrixXd Normals(int count, int width, double mean, base::Random& random) {
  Eigen::MatrixXd points(count, width);
  for (double& value : points.reshaped()) value = mean + random.Normal();
  return points;
}

MmdResult Mmd(const std::vector<SamplePair>& pairs, const MmdConfig& config, uint64_t seed = 1) {
  base::Random random(seed);
  const auto result = MaximumMeanDiscrepancy(pairs, config, random);
  EXPECT_TRUE(result.ok()) << result.status();
  return result.value_or(MmdResult{});
}

// x = {0, 1}, y = {0, 3}: squared distances 1, 0, 9, 1, 4, 9, mean 4.
SamplePair ByHand() {
  SamplePair pair;
  pair.x = Eigen::Vector2d(0, 1);
  pair.y = Eigen::Vector2d(0, 3);
  return pair;
}

double Kernel(double squared) {
  double sum = 0;
  for (const double width : {1.0, 2.0, 4.0, 8.0, 16.0}) sum += std::exp(-squared / width);
  return sum;
}

TEST(MmdTest, UnbiasedIsTheSumByHand) {
  const double across = (5 + Kernel(9) + Kernel(1) + Kernel(4)) / 4;
  EXPECT_NEAR(Mmd({ByHand()}, {.permutations = 0}).squared_mmd, Kernel(1) + Kernel(9) - 2 * across,
              1e-12);
}

TEST(MmdTest, BiasedIsTheAuthorsMean) {
  const double across = (5 + Kernel(9) + Kernel(1) + Kernel(4)) / 4;
  EXPECT_NEAR(Mmd({ByHand()}, {.estimator = "biased", .permutations = 0}).squared_mmd,
              (5 + Kernel(1)) / 2 + (5 + Kernel(9)) / 2 - 2 * across, 1e-12);
}

TEST(MmdTest, OfOneDistributionTheUnbiasedOneIsZeroOnAverage) {
  base::Random random(2);
  double unbiased = 0, biased = 0;
  constexpr int kTrials = 400;
  for (int i = 0; i < kTrials; ++i) {
    const SamplePair pair{Normals(8, 3, 0, random), Normals(8, 3, 0, random)};
    unbiased += Mmd({pair}, {.permutations = 0}).squared_mmd / kTrials;
    biased += Mmd({pair}, {.estimator = "biased", .permutations = 0}).squared_mmd / kTrials;
  }
  EXPECT_NEAR(unbiased, 0, 0.03);
  EXPECT_GT(biased, 0.5);
}

TEST(MmdTest, OfALargerSampleTheMeanOverDrawsOfAsManyCounts) {
  const Eigen::MatrixXd x = Eigen::Vector3d(0, 1, 5), y = Eigen::Vector2d(0, 3);
  const MmdConfig config{.permutations = 0, .draws = 4000};
  double mean = 0;
  for (const auto& rows : {std::vector{0, 1}, std::vector{0, 2}, std::vector{1, 2}}) {
    mean += Mmd({{x(rows, Eigen::all), y}}, config).squared_mmd / 3;
  }
  EXPECT_NEAR(Mmd({{x, y}}, config).squared_mmd, mean, 0.05);
}

TEST(MmdTest, PValuesOfOneDistributionAreEven) {
  base::Random random(3);
  int below_a_fifth = 0;
  for (uint64_t i = 0; i < 200; ++i) {
    const SamplePair pair{Normals(6, 2, 0, random), Normals(6, 2, 0, random)};
    below_a_fifth += Mmd({pair}, {.permutations = 99}, i).p_value <= 0.2 ? 1 : 0;
  }
  // 40 expected, deviation 5.7.
  EXPECT_GT(below_a_fifth, 20);
  EXPECT_LT(below_a_fifth, 60);
}

TEST(MmdTest, FoldsTogetherTellApartWhatEachAloneDoesNot) {
  base::Random random(6);
  std::vector<SamplePair> folds;
  for (int i = 0; i < 8; ++i) folds.push_back({Normals(6, 2, 0, random), Normals(6, 2, 1, random)});
  EXPECT_LT(Mmd(folds, {.permutations = 999}).p_value, 0.005);
  double mean = 0, mean_p = 0;
  for (const SamplePair& fold : folds) {
    mean += Mmd({fold}, {.permutations = 0}).squared_mmd / 8;
    mean_p += Mmd({fold}, {.permutations = 199}).p_value / 8;
  }
  EXPECT_NEAR(Mmd(folds, {.permutations = 0}).squared_mmd, mean, 1e-12);
  EXPECT_GT(mean_p, 0.02);
}

TEST(MmdTest, WhatCannotBeComparedIsRefused) {
  base::Random random(1);
  const auto reason = [&](const std::vector<SamplePair>& pairs) {
    return base::ErrorReason(MaximumMeanDiscrepancy(pairs, {}, random).status());
  };
  EXPECT_EQ(reason({}), "TOO_FEW_SAMPLES");
  EXPECT_EQ(reason({{Eigen::MatrixXd::Zero(1, 2), Eigen::MatrixXd::Zero(4, 2)}}),
            "TOO_FEW_SAMPLES");
  EXPECT_EQ(reason({{Eigen::MatrixXd::Zero(3, 2), Eigen::MatrixXd::Zero(3, 1)}}), "WRONG_SHAPE");
}

}  // namespace
}  // namespace poise::motion
