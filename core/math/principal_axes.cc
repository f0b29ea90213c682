#include "core/math/principal_axes.h"

#include <Eigen/Eigenvalues>

namespace poise::math {

PrincipalAxes FindPrincipalAxes(const Eigen::MatrixXd& points, int count) {
  PrincipalAxes found;
  found.mean = points.colwise().mean();
  const Eigen::MatrixXd centred = points.rowwise() - found.mean;
  const Eigen::MatrixXd covariance =
      centred.transpose() * centred / static_cast<double>(points.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);  // ascending
  found.axes = solver.eigenvectors().rightCols(count).rowwise().reverse();
  found.variances = solver.eigenvalues().tail(count).reverse();
  found.total_variance = covariance.trace();
  for (int i = 0; i < count; ++i) {
    Eigen::Index greatest = 0;
    found.axes.col(i).cwiseAbs().maxCoeff(&greatest);
    if (found.axes(greatest, i) < 0) found.axes.col(i) *= -1;
  }
  return found;
}

}  // namespace poise::math
