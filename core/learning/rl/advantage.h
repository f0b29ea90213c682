#ifndef POISE_CORE_LEARNING_RL_ADVANTAGE_H_
#define POISE_CORE_LEARNING_RL_ADVANTAGE_H_

#include <span>
#include <vector>

#include "core/learning/rl/batch.h"

namespace poise::rl {

/// Generalised advantage estimation (Schulman et al. 2016, eq. 16): with
/// delta_t = r_t + discount V(s_t+1) - V(s_t), A_t = sum over k of (discount trace)^k delta_t+k,
/// within an episode. V(s_t+1) is 0 after a termination, and the value after the cut where an
/// episode was truncated.
/// Shapes: values (rows) of the observations of the batch; cut_values (cuts).
struct Advantages {
  std::vector<float> advantages;  // (rows)
  std::vector<float> returns;     // (rows) advantage + value: what the value function learns
};
Advantages EstimateAdvantages(const Batch& batch, std::span<const float> values,
                              std::span<const float> cut_values, double discount, double trace);

/// To mean 0 and deviation 1 over the explored rows, then clipped to +- `limit` (0 = off). Equal
/// advantages become 0.
void StandardizeAdvantages(const Batch& batch, double limit, std::span<float> advantages);

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_ADVANTAGE_H_
