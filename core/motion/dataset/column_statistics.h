#ifndef POISE_CORE_MOTION_DATASET_COLUMN_STATISTICS_H_
#define POISE_CORE_MOTION_DATASET_COLUMN_STATISTICS_H_

#include <vector>

#include "core/motion/pose_codec.h"

namespace poise::motion {

/// Mean and population deviation of each column of tables of poses, for normalisation and for what
/// counts in an error.
/// Source: reference sec. 1.5 (in double precision; the authors' sums are single).
struct ColumnStatistics {
  /// A column with a smaller deviation is constant [unit of the column].
  static constexpr double kConstantDeviation = 1e-4;

  Eigen::VectorXd mean;       // (columns)
  Eigen::VectorXd deviation;  // (columns)

  /// Preconditions: equal numbers of columns; at least one row.
  static ColumnStatistics Of(const std::vector<PoseMatrix>& tables);

  /// True where a column moves.
  std::vector<bool> moving() const;
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_COLUMN_STATISTICS_H_
