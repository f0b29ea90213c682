#include "core/learning/rl/advantage.h"

#include <algorithm>
#include <cmath>

namespace poise::rl {

Advantages EstimateAdvantages(const Batch& batch, std::span<const float> values,
                              std::span<const float> cut_values, double discount, double trace) {
  Advantages result;
  result.advantages.resize(batch.rows());
  result.returns.resize(batch.rows());
  // From the last row backwards, slot by slot: a slot's last step has an ending, so nothing leaks
  // from the slot after it.
  auto cut = static_cast<int>(batch.cut_rows.size());
  double next_value = 0, next_advantage = 0;
  for (int row = batch.rows() - 1; row >= 0; --row) {
    if (batch.endings[row] != Ending::kNone) next_advantage = 0;
    if (batch.endings[row] == Ending::kTerminated) next_value = 0;
    if (batch.endings[row] == Ending::kTruncated) next_value = cut_values[--cut];
    const double delta = batch.rewards[row] + discount * next_value - values[row];
    next_advantage = delta + discount * trace * next_advantage;
    next_value = values[row];
    result.advantages[row] = static_cast<float>(next_advantage);
    result.returns[row] = static_cast<float>(next_advantage + next_value);
  }
  return result;
}

void StandardizeAdvantages(const Batch& batch, double limit, std::span<float> advantages) {
  constexpr double kSmallestDeviation = 1e-8;
  double sum = 0, count = 0;
  for (size_t row = 0; row < advantages.size(); ++row) {
    if (batch.explored[row] == 0) continue;
    sum += advantages[row];
    ++count;
  }
  const double mean = count > 0 ? sum / count : 0;
  double squares = 0;
  for (size_t row = 0; row < advantages.size(); ++row) {
    if (batch.explored[row] != 0) squares += (advantages[row] - mean) * (advantages[row] - mean);
  }
  const double deviation = count > 0 ? std::sqrt(squares / count) : 0;
  for (float& advantage : advantages) {
    double value = (advantage - mean) / std::max(deviation, kSmallestDeviation);
    if (limit > 0) value = std::clamp(value, -limit, limit);
    advantage = static_cast<float>(value);
  }
}

}  // namespace poise::rl
