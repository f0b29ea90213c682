#include "core/motion/metrics/euler_error.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace poise::motion {
namespace {

constexpr double kAngleEpsilon = 1.1920929e-7;  // single precision's, as in the authors' program
constexpr double kMovingDeviation = 1e-4;       // [rad]
constexpr int kRootColumns = 3;

// I + sin K + (1 - cos) K K for the axis u = r / (angle + epsilon), which is not quite of length 1.
math::Mat3 MatrixOf(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Vec3 axis = rotation_vector / (angle + kAngleEpsilon);
  math::Mat3 cross;
  cross << 0, -axis.z(), axis.y(),  //
      axis.z(), 0, -axis.x(),       //
      -axis.y(), axis.x(), 0;
  return math::Mat3::Identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * cross * cross;
}

PoseMatrix EulerTable(const PoseMatrix& vectors) {
  PoseMatrix angles(vectors.rows(), vectors.cols());
  for (Eigen::Index frame = 0; frame < vectors.rows(); ++frame) {
    for (Eigen::Index column = 0; column < vectors.cols(); column += 3) {
      angles.block<1, 3>(frame, column) =
          EulerOfRotationVector(vectors.block<1, 3>(frame, column).transpose()).transpose();
    }
  }
  return angles;
}

double PopulationDeviation(const PoseMatrix& table, Eigen::Index column) {
  const auto values = table.col(column).array();
  return std::sqrt((values - values.mean()).square().mean());
}

}  // namespace

PoseMatrix RotationVectors(const Clip& clip, RotationSense sense) {
  const double sign = sense == RotationSense::kRowVectors ? -1 : 1;
  PoseMatrix vectors(clip.num_frames(), 3 * clip.num_joints());
  for (int frame = 0; frame < clip.num_frames(); ++frame) {
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      vectors.block<1, 3>(frame, 3 * joint) =
          sign * math::ToRotationVector(clip.rotation(frame, joint)).transpose();
    }
  }
  return vectors;
}

Vec3 EulerOfRotationVector(const Vec3& rotation_vector) {
  const math::Mat3 matrix = MatrixOf(rotation_vector);
  const double sine = matrix(0, 2);
  if (std::abs(sine) >= 1) {
    return {std::atan2(matrix(0, 1), sine), -std::copysign(std::numbers::pi / 2, sine), 0};
  }
  const double second = -std::asin(sine);
  const double cosine = std::cos(second);
  return {std::atan2(matrix(1, 2) / cosine, matrix(2, 2) / cosine), second,
          std::atan2(matrix(0, 1) / cosine, matrix(0, 0) / cosine)};
}

StatusOr<std::vector<double>> EulerErrors(const PoseMatrix& target, const PoseMatrix& prediction,
                                          const ColumnMask& counts, EulerErrorVariant variant) {
  const Eigen::Index columns = target.cols();
  if (columns % 3 != 0 || prediction.cols() != columns || prediction.rows() != target.rows() ||
      static_cast<Eigen::Index>(counts.size()) != columns) {
    return base::InvalidArgument(
        "WRONG_SHAPE", "prediction",
        fmt::format("target is {} x {}, prediction {} x {}, mask {}: expected equal shapes with a "
                    "multiple of 3 columns",
                    target.rows(), columns, prediction.rows(), prediction.cols(), counts.size()));
  }
  const PoseMatrix wanted = EulerTable(target);
  const PoseMatrix given = EulerTable(prediction);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(target.rows());
  for (Eigen::Index column = kRootColumns; column < columns; ++column) {
    if (!counts[column]) continue;
    if (variant == EulerErrorVariant::kMovingColumns &&
        PopulationDeviation(wanted, column) <= kMovingDeviation) {
      continue;
    }
    sums += (wanted.col(column) - given.col(column)).cwiseAbs2();
  }
  const Eigen::VectorXd errors = sums.cwiseSqrt();
  return std::vector<double>(errors.begin(), errors.end());
}

}  // namespace poise::motion
