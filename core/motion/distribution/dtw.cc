#include "core/motion/distribution/dtw.h"

#include <algorithm>
#include <vector>

namespace poise::motion {

double DtwDistance(const FrameFeatures& a, const FrameFeatures& b, double limit) {
  const Eigen::Index rows = a.rows(), columns = b.rows();
  const double most = limit * static_cast<double>(std::max(rows, columns));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Cheapest way to each frame of b, for the present frame of a and the one before.
  std::vector<double> above(columns, kInfinity), here(columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    double least = kInfinity;
    for (Eigen::Index j = 0; j < columns; ++j) {
      double before = above[j];
      if (j > 0) before = std::min({before, here[j - 1], above[j - 1]});
      if (i == 0 && j == 0) before = 0;
      here[j] = before + static_cast<double>((a.row(i) - b.row(j)).norm());
      least = std::min(least, here[j]);
    }
    // Every way passes this row, and gets no cheaper.
    if (least > most) return kInfinity;
    std::swap(above, here);
  }
  const double distance = above.back() / static_cast<double>(std::max(rows, columns));
  return distance > limit ? kInfinity : distance;
}

NearestMotion FindNearest(const FrameFeatures& motion, std::span<const FrameFeatures> set,
                          int left_out) {
  NearestMotion nearest;
  for (int i = 0; i < static_cast<int>(set.size()); ++i) {
    if (i == left_out) continue;
    const double distance = DtwDistance(motion, set[i], nearest.distance);
    if (distance < nearest.distance) nearest = {i, distance};
  }
  return nearest;
}

}  // namespace poise::motion
