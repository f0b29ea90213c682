#include "core/motion/dataset/column_statistics.h"

namespace poise::motion {

ColumnStatistics ColumnStatistics::Of(const std::vector<PoseMatrix>& tables) {
  const Eigen::Index columns = tables.front().cols();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(columns);
  double rows = 0;
  for (const PoseMatrix& table : tables) {
    sum += table.colwise().sum();
    rows += static_cast<double>(table.rows());
  }
  const Eigen::RowVectorXd mean = sum / rows;
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(columns);
  for (const PoseMatrix& table : tables) {
    squares += (table.rowwise() - mean).cwiseAbs2().colwise().sum();
  }
  return {mean.transpose(), (squares / rows).cwiseSqrt().transpose()};
}

std::vector<bool> ColumnStatistics::moving() const {
  std::vector<bool> moving(deviation.size());
  for (Eigen::Index i = 0; i < deviation.size(); ++i)
    moving[i] = deviation[i] >= kConstantDeviation;
  return moving;
}

}  // namespace poise::motion
