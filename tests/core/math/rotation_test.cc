#include "core/math/rotation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/random.h"

namespace poise::math {
namespace {

constexpr double kPi = std::numbers::pi;

Quat RandomRotation(base::Random& random) {
  return Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal()).normalized();
}

Mat3 Elementary(int axis, double angle) {
  return Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix();
}

std::vector<EulerOrder> AllOrders() {
  std::vector<EulerOrder> orders;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      for (int c = 0; c < 3; ++c) {
        if (a != b && b != c) orders.push_back({{a, b, c}});
      }
    }
  }
  return orders;
}

TEST(RotationTest, FromEulerIsTheProductOfElementaryMatricesInEveryOrder) {
  base::Random random(1);
  for (const EulerOrder& order : AllOrders()) {
    for (int i = 0; i < 20; ++i) {
      const Vec3 angles(random.Uniform(-4, 4), random.Uniform(-4, 4), random.Uniform(-4, 4));
      const Mat3 expected = Elementary(order.axes[0], angles[0]) *
                            Elementary(order.axes[1], angles[1]) *
                            Elementary(order.axes[2], angles[2]);
      EXPECT_LT((FromEuler(angles, order).toRotationMatrix() - expected).norm(), 1e-12)
          << EulerOrderName(order);
    }
  }
}

TEST(RotationTest, EulerRoundTripKeepsTheRotationInEveryOrder) {
  base::Random random(2);
  for (const EulerOrder& order : AllOrders()) {
    for (int i = 0; i < 200; ++i) {
      const Quat rotation = RandomRotation(random);
      EXPECT_LT(GeodesicDistance(FromEuler(ToEuler(rotation, order), order), rotation), 1e-7)
          << EulerOrderName(order);
    }
  }
}

TEST(RotationTest, EulerRoundTripHoldsAtGimbalLock) {
  base::Random random(3);
  for (const EulerOrder& order : AllOrders()) {
    const bool proper = order.axes[0] == order.axes[2];
    for (const double middle : {proper ? 0.0 : -kPi / 2, proper ? kPi : kPi / 2}) {
      const Quat rotation =
          FromEuler(Vec3(random.Uniform(-3, 3), middle, random.Uniform(-3, 3)), order);
      EXPECT_LT(GeodesicDistance(FromEuler(ToEuler(rotation, order), order), rotation), 1e-6)
          << EulerOrderName(order) << " " << middle;
    }
  }
}

TEST(RotationTest, RotationVectorRoundTripsAlsoNearZeroAndPi) {
  base::Random random(4);
  for (const double angle : {0.0, 1e-12, 1e-7, 1e-3, 1.0, 3.0, kPi - 1e-9, kPi}) {
    const Vec3 axis = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
    const Quat expected(Eigen::AngleAxisd(angle, axis));
    const Quat rotation = FromRotationVector(angle * axis);
    EXPECT_LT(GeodesicDistance(rotation, expected), 1e-12) << angle;
    EXPECT_LT(GeodesicDistance(FromRotationVector(ToRotationVector(rotation)), rotation), 1e-12);
  }
}

TEST(RotationTest, UnwrappedRotationVectorsGrowSteadilyOverSeveralTurns) {
  const Vec3 axis = Vec3(1, 2, -0.5).normalized();
  Vec3 previous = Vec3::Zero();
  for (int i = 1; i < 400; ++i) {
    const double angle = 0.05 * i;  // up to more than three turns
    const Vec3 wrapped = ToRotationVector(Quat(Eigen::AngleAxisd(angle, axis)));
    const Vec3 unwrapped = UnwrapRotationVector(wrapped, previous);
    EXPECT_NEAR((unwrapped - angle * axis).norm(), 0, 1e-9) << i;
    previous = unwrapped;
  }
}

TEST(RotationTest, SixDRoundTripsAndRefusesParallelColumns) {
  base::Random random(5);
  const Quat rotation = RandomRotation(random);
  EXPECT_LT(GeodesicDistance(*FromSixD(ToSixD(rotation)), rotation), 1e-12);
  Vec6 scaled = ToSixD(rotation);
  scaled.head<3>() *= 7;
  EXPECT_LT(GeodesicDistance(*FromSixD(scaled), rotation), 1e-12);
  Vec6 parallel;
  parallel << 1, 2, 3, 2, 4, 6;
  EXPECT_EQ(base::ErrorReason(FromSixD(parallel).status()), "DEGENERATE_ROTATION");
}

TEST(RotationTest, FromMatrixRefusesReflectionsAndScales) {
  EXPECT_TRUE(FromMatrix(Elementary(0, 0.3)).ok());
  EXPECT_FALSE(FromMatrix(-Mat3::Identity()).ok());
  EXPECT_FALSE(FromMatrix(1.01 * Mat3::Identity()).ok());
}

TEST(RotationTest, TwistAboutAnAxisLeavesASwingPerpendicularToIt) {
  base::Random random(6);
  for (int i = 0; i < 50; ++i) {
    const Quat rotation = RandomRotation(random);
    const Vec3 axis = Vec3(random.Normal(), random.Normal(), random.Normal()).normalized();
    const Quat swing = rotation * TwistAbout(rotation, axis).conjugate();
    EXPECT_NEAR(swing.vec().dot(axis), 0, 1e-12);
  }
}

TEST(RotationTest, SwingBetweenTurnsOneDirectionOntoTheOther) {
  base::Random random(7);
  for (int i = 0; i < 50; ++i) {
    const Vec3 from(random.Normal(), random.Normal(), random.Normal());
    const Vec3 to(random.Normal(), random.Normal(), random.Normal());
    EXPECT_LT((SwingBetween(from, to) * from.normalized() - to.normalized()).norm(), 1e-9);
  }
  EXPECT_LT((SwingBetween(Vec3(0, 1, 0), Vec3(0, -1, 0)) * Vec3(0, 1, 0) - Vec3(0, -1, 0)).norm(),
            1e-9);
}

TEST(RotationTest, EulerOrderNamesParseAndBadOnesAreRefused) {
  EXPECT_EQ(*ParseEulerOrder("ZXY"), kZXY);
  EXPECT_EQ(EulerOrderName(*ParseEulerOrder("zyx")), "ZYX");
  for (const char* bad : {"", "XX", "XXY", "XYW", "XYZX"}) EXPECT_FALSE(ParseEulerOrder(bad).ok());
}

}  // namespace
}  // namespace poise::math
