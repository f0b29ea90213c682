#ifndef POISE_CORE_MATH_PRINCIPAL_AXES_H_
#define POISE_CORE_MATH_PRINCIPAL_AXES_H_

#include <Eigen/Core>

namespace poise::math {

/// The directions in which points differ most.
struct PrincipalAxes {
  Eigen::RowVectorXd mean;    ///< (dimensions)
  Eigen::MatrixXd axes;       ///< (dimensions, count) orthonormal, by falling variance; of each the
                              ///< component of greatest size is positive
  Eigen::VectorXd variances;  ///< (count) along them
  double total_variance = 0;  ///< over all directions

  /// (points, dimensions) -> (points, count)
  Eigen::MatrixXd Project(const Eigen::MatrixXd& points) const {
    return (points.rowwise() - mean) * axes;
  }
};

/// Principal component analysis. Shape: points (points, dimensions), at least one.
/// Precondition: 1 <= count <= dimensions.
PrincipalAxes FindPrincipalAxes(const Eigen::MatrixXd& points, int count);

}  // namespace poise::math

#endif  // POISE_CORE_MATH_PRINCIPAL_AXES_H_
