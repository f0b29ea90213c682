#include "core/learning/rl/running_moments.h"

#include <algorithm>
#include <cmath>

namespace poise::rl {

void RunningMoments::Add(std::span<const float> rows) {
  const size_t width = mean.size();
  const auto added = static_cast<int64_t>(rows.size() / width);
  if (added == 0) return;
  std::vector<double> rows_mean(width), rows_squares(width);
  for (size_t i = 0; i < rows.size(); ++i) rows_mean[i % width] += rows[i];
  for (double& value : rows_mean) value /= static_cast<double>(added);
  for (size_t i = 0; i < rows.size(); ++i) {
    const double difference = rows[i] - rows_mean[i % width];
    rows_squares[i % width] += difference * difference;
  }
  const double share = static_cast<double>(added) / static_cast<double>(count + added);
  for (size_t d = 0; d < width; ++d) {
    const double shift = rows_mean[d] - mean[d];
    mean[d] += shift * share;
    squares[d] += rows_squares[d] + shift * shift * share * static_cast<double>(count);
  }
  count += added;
}

double RunningMoments::Deviation(int dimension, double floor) const {
  if (count == 0) return 1;
  return std::max(floor, std::sqrt(squares[dimension] / static_cast<double>(count)));
}

ObservationScale ObservationScale::FromMoments(const RunningMoments& moments, double deviation_min,
                                               double limit) {
  ObservationScale scale;
  scale.limit = static_cast<float>(limit);
  for (int d = 0; d < moments.dimensions(); ++d) {
    scale.mean.push_back(static_cast<float>(moments.mean[d]));
    scale.inverse_deviation.push_back(static_cast<float>(1 / moments.Deviation(d, deviation_min)));
  }
  return scale;
}

void ObservationScale::Apply(std::span<const float> rows, std::span<float> scaled) const {
  const size_t width = mean.size();
  for (size_t begin = 0; begin < rows.size(); begin += width) {
    for (size_t d = 0; d < width; ++d) {
      const float value = (rows[begin + d] - mean[d]) * inverse_deviation[d];
      scaled[begin + d] = limit > 0 ? std::clamp(value, -limit, limit) : value;
    }
  }
}

}  // namespace poise::rl
