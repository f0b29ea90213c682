#include "core/learning/rl/batch.h"

namespace poise::rl {

Batch::Batch(int slots, int steps, int observation_size, int action_size)
    : slots(slots), steps(steps), observation_size(observation_size), action_size(action_size) {
  const auto rows = static_cast<size_t>(slots) * steps;
  observations.resize(rows * observation_size);
  actions.resize(rows * action_size);
  log_probs.resize(rows);
  rewards.resize(rows);
  explored.resize(rows);
  endings.resize(rows);
}

}  // namespace poise::rl
