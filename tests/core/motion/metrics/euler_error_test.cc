#include "core/motion/metrics/euler_error.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

// Reference sec. 1.8.
TEST(EulerOfRotationVectorTest, GivesTheWorkedValues) {
  const struct {
    Vec3 vector, angles;
  } cases[] = {{{0.3, -0.2, 0.5}, {-0.338416359, 0.115171391, -0.525115079}},
               {{1.2, 0.4, -0.9}, {-1.208700185, 0.18330266, 0.908138962}},
               {{0, 0, 0.7}, {0, 0, -0.699999864}}};
  for (const auto& c : cases) {
    EXPECT_LT((EulerOfRotationVector(c.vector) - c.angles).cwiseAbs().maxCoeff(), 5e-10)
        << EulerOfRotationVector(c.vector).transpose();
  }
}

TEST(EulerOfRotationVectorTest, NegatedAnglesMultiplyToTheRotation) {
  const Vec3 vector(-0.7, 1.1, 0.4);
  const Quat product = math::FromEuler(-EulerOfRotationVector(vector), math::kXYZ);
  EXPECT_LT(math::GeodesicDistance(product, math::FromRotationVector(vector)), 1e-6);
}

TEST(EulerOfRotationVectorTest, IsFiniteAtTheGimbalLock) {
  for (const double sign : {-1.0, 1.0}) {
    const Vec3 angles = EulerOfRotationVector({0, sign * std::numbers::pi / 2, 0});
    EXPECT_TRUE(angles.allFinite());
    EXPECT_NEAR(angles[1], -sign * std::numbers::pi / 2, 1e-3);
  }
}

TEST(RotationVectorsTest, RowVectorsAreTheNegatedOnes) {
  const Clip clip = testing::SwingingClip(5);
  const PoseMatrix columns = RotationVectors(clip, RotationSense::kColumnVectors);
  EXPECT_EQ(columns.rows(), 5);
  EXPECT_EQ(columns.cols(), 3 * clip.num_joints());
  EXPECT_EQ(RotationVectors(clip, RotationSense::kRowVectors), -columns);
  EXPECT_LT((math::FromRotationVector(columns.block<1, 3>(4, 6).transpose()).coeffs() -
             clip.rotation(4, 2).coeffs())
                .norm(),
            1e-12);
}

// Of two joints besides the root the first turns about z: its third angle is minus the angle.
class EulerErrorsTest : public ::testing::Test {
 protected:
  EulerErrorsTest() : target_(PoseMatrix::Zero(3, 9)), prediction_(PoseMatrix::Zero(3, 9)) {
    target_.col(5) << 0.1, 0.2, 0.3;
  }
  PoseMatrix target_, prediction_;
  ColumnMask counts_ = ColumnMask(9, true);
};

TEST_F(EulerErrorsTest, IsTheNormOverCountingColumnsPerFrame) {
  const auto errors = EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kMovingColumns);
  ASSERT_TRUE(errors.ok());
  EXPECT_NEAR((*errors)[0], 0.1, 1e-6);
  EXPECT_NEAR((*errors)[2], 0.3, 1e-6);
  counts_[5] = false;
  EXPECT_EQ((*EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kAllColumns))[2], 0);
}

TEST_F(EulerErrorsTest, RootNeverCounts) {
  prediction_.leftCols(3).setConstant(0.5);
  target_.leftCols(3).col(0) << 1, 2, 3;
  const auto errors = EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kAllColumns);
  EXPECT_NEAR((*errors)[1], 0.2, 1e-6);
}

TEST_F(EulerErrorsTest, ColumnsAtRestInTheTargetCountInOneVariantOnly) {
  prediction_.col(5) = target_.col(5);
  prediction_.col(6).setConstant(0.4);
  EXPECT_NEAR((*EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kMovingColumns))[0],
              0, 1e-6);
  EXPECT_GT((*EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kAllColumns))[0], 0.39);
}

TEST_F(EulerErrorsTest, DifferencesAreNotWrapped) {
  target_.col(5).setConstant(3.1);
  prediction_.col(5).setConstant(-3.1);
  const auto errors = EulerErrors(target_, prediction_, counts_, EulerErrorVariant::kAllColumns);
  EXPECT_NEAR((*errors)[0], 6.2, 1e-5);
}

TEST_F(EulerErrorsTest, ShapesThatDifferAreRefused) {
  EXPECT_EQ(base::ErrorReason(EulerErrors(target_, prediction_.topRows(2), counts_,
                                          EulerErrorVariant::kAllColumns)
                                  .status()),
            "WRONG_SHAPE");
}

}  // namespace
}  // namespace poise::motion
