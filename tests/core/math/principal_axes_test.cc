#include "core/math/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace poise::math {
namespace {

TEST(PrincipalAxesTest, AreThoseOfAnEllipse) {
  // Deviations 3 along (3, 4) / 5 and 1 across, about (10, -2).
  base::Random random(1);
  Eigen::MatrixXd points(4000, 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double along = 3 * random.Normal(), across = random.Normal();
    points.row(i) << 10 + 0.6 * along - 0.8 * across, -2 + 0.8 * along + 0.6 * across;
  }
  const PrincipalAxes found = FindPrincipalAxes(points, 2);
  EXPECT_NEAR(found.axes(0, 0), 0.6, 0.02);
  EXPECT_NEAR(found.axes(1, 0), 0.8, 0.02);
  EXPECT_NEAR(found.variances[0], 9, 0.5);
  EXPECT_NEAR(found.variances[1], 1, 0.05);
  EXPECT_NEAR(found.total_variance, found.variances.sum(), 1e-9);
  EXPECT_TRUE((found.axes.transpose() * found.axes).isIdentity(1e-12));
}

TEST(PrincipalAxesTest, ProjectionsKeepDistancesWithinTheAxes) {
  Eigen::MatrixXd points(4, 3);
  points << 0, 0, 5, 1, 1, 5, 2, 2, 5, 3, 3, 5;
  const Eigen::MatrixXd line = FindPrincipalAxes(points, 1).Project(points);
  for (int i = 0; i + 1 < 4; ++i) EXPECT_NEAR(line(i + 1, 0) - line(i, 0), std::sqrt(2), 1e-12);
  EXPECT_NEAR(line.sum(), 0, 1e-12);
}

}  // namespace
}  // namespace poise::math
