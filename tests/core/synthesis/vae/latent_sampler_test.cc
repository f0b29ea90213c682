#include "core/synthesis/vae/latent_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace poise::synthesis {
namespace {

// Six motions of two dimensions in two clusters, around (0, 0) and (100, 0).
Eigen::MatrixXd Means() {
  Eigen::MatrixXd means(6, 2);
  means << 0, 0, 1, 0, 0, 1, 100, 0, 101, 0, 100, 1;
  return means;
}

struct Moments {
  Eigen::Vector2d mean, variance;
};

Moments Measure(const LatentSampler& sampler, int draws = 40'000) {
  base::Random random(3);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();
  for (int i = 0; i < draws; ++i) {
    const Eigen::Vector2d z = sampler.Draw(random);
    sum += z;
    squares += z.cwiseAbs2();
  }
  const Eigen::Vector2d mean = sum / draws;
  return {mean, squares / draws - mean.cwiseAbs2()};
}

TEST(LatentSamplerTest, PriorIsAStandardNormal) {
  const LatentSampler sampler(Means(), Eigen::MatrixXd::Constant(6, 2, 50), {.mode = "prior"}, 1);
  const Moments moments = Measure(sampler);
  EXPECT_NEAR(moments.mean[0], 0, 0.03);
  EXPECT_NEAR(moments.variance[1], 1, 0.03);
}

TEST(LatentSamplerTest, VariancesAreAveragedOrDeviationsAsAsked) {
  // Two motions at the same place: variances 1 and 9.
  Eigen::MatrixXd variances(2, 2);
  variances << 1, 1, 9, 9;
  const Eigen::MatrixXd means = Eigen::MatrixXd::Constant(2, 2, 5);
  const LatentSampler paper(means, variances, {.clusters = 1}, 1);
  EXPECT_NEAR(Measure(paper).variance[0], (1 + 9) / 2.0, 0.15);
  const LatentSampler authors(means, variances, {.clusters = 1, .average = "deviation"}, 1);
  EXPECT_NEAR(Measure(authors).variance[0], std::pow((1 + 3) / 2.0, 2), 0.12);
  EXPECT_NEAR(Measure(authors).mean[0], 5, 0.05);
}

TEST(LatentSamplerTest, NearStaysInOneClusterAndPairDoesNot) {
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(6, 2);
  const LatentSampler near(Means(), none, {.clusters = 2}, 1);
  const LatentSampler pair(Means(), none, {.mode = "pair"}, 1);
  base::Random random(2);
  int between = 0;
  std::set<std::pair<double, double>> different;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd z = near.Draw(random);
    EXPECT_TRUE(z[0] <= 1 || z[0] >= 100) << z[0];
    different.insert({z[0], z[1]});
    const double x = pair.Draw(random)[0];
    between += x > 1 && x < 100;
  }
  // Pairs of three without replacement: three points in each cluster, and none is a motion itself.
  EXPECT_EQ(different.size(), 6u);
  EXPECT_FALSE(different.contains({0, 0}));
  // Of 15 pairs 9 lie across: binomial of 2000 draws, five deviations.
  EXPECT_NEAR(between, 1200, 110);
}

TEST(LatentSamplerTest, LargerClustersAreChosenMoreOften) {
  Eigen::MatrixXd means(4, 1);
  means << 0, 1, 2, 100;
  const LatentSampler sampler(means, Eigen::MatrixXd::Zero(4, 1), {.clusters = 2, .near = 3}, 1);
  base::Random random(2);
  int lone = 0;
  for (int i = 0; i < 4000; ++i) lone += sampler.Draw(random)[0] > 50;
  EXPECT_NEAR(lone, 1000, 140);
}

}  // namespace
}  // namespace poise::synthesis
