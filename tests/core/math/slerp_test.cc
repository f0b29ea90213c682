#include "core/math/slerp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace poise::math {
namespace {

Quat RandomRotation(base::Random& random) {
  return Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal()).normalized();
}

// A rotation that is `angle` away from `a`.
Quat TurnedBy(const Quat& a, double angle, base::Random& random) {
  const Vec3 axis = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
  return (a * Quat(Eigen::AngleAxisd(angle, axis))).normalized();
}

// By the definition, in long double, with the angle from both its sine and its cosine.
Quat Reference(const Quat& a, const Quat& b, double u) {
  using Wide = Eigen::Matrix<long double, 4, 1>;
  Wide from = a.coeffs().cast<long double>(), to = b.coeffs().cast<long double>();
  from.normalize();
  to.normalize();
  if (from.dot(to) < 0) to = -to;
  const long double angle = 2 * std::atan2((to - from).norm(), (to + from).norm());
  if (angle == 0) return a;
  const Wide sum = (std::sin((1 - u) * angle) * from + std::sin(u * angle) * to) / std::sin(angle);
  Quat result;
  result.coeffs() = sum.cast<double>();
  return result;
}

TEST(SlerpTest, IsTheSphericalInterpolationToRoundingAtEveryAngle) {
  base::Random random(1);
  double worst = 0, worst_length = 0;
  for (double angle = 1e-9; angle < 3.1; angle *= 1.02) {
    for (int i = 0; i < 20; ++i) {
      const Quat a = RandomRotation(random);
      Quat b = TurnedBy(a, angle, random);
      if (i % 2 == 0) b.coeffs() *= -1;  // the other sign of the same rotation
      const double u = random.Uniform(0, 1);
      const Quat result = Slerp(a, b, u);
      worst = std::max(worst, (result.coeffs() - Reference(a, b, u).coeffs()).norm());
      worst_length = std::max(worst_length, std::abs(result.norm() - 1));
    }
  }
  EXPECT_LT(worst, 1e-15);
  EXPECT_LT(worst_length, 1e-15);
}

TEST(SlerpTest, TheEndsAreKeptBitForBit) {
  base::Random random(2);
  for (const double angle : {0.0, 1e-3, 0.3, 0.5, 3.0}) {
    const Quat a = RandomRotation(random), b = TurnedBy(a, angle, random);
    EXPECT_EQ(Slerp(a, b, 0).coeffs(), a.coeffs());
    EXPECT_EQ(Slerp(a, b, 1).coeffs(), b.coeffs());
  }
}

TEST(SlerpTest, OneObjectServesManyPairs) {
  base::Random random(3);
  const SlerpAt slerp(0.3);
  for (int i = 0; i < 100; ++i) {
    const Quat a = RandomRotation(random), b = TurnedBy(a, random.Uniform(0, 3), random);
    EXPECT_EQ(slerp(a, b).coeffs(), Slerp(a, b, 0.3).coeffs());
  }
}

TEST(SlerpTest, GoesTheShorterWay) {
  const Quat a = Quat::Identity(), b(Eigen::AngleAxisd(0.2, Vec3::UnitY()));
  const Quat other(-b.w(), -b.x(), -b.y(), -b.z());
  EXPECT_LT(GeodesicDistance(Slerp(a, other, 0.5), Quat(Eigen::AngleAxisd(0.1, Vec3::UnitY()))),
            1e-15);
}

}  // namespace
}  // namespace poise::math
