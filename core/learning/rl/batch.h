#ifndef POISE_CORE_LEARNING_RL_BATCH_H_
#define POISE_CORE_LEARNING_RL_BATCH_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace poise::rl {

/// What follows a step.
enum class Ending : uint8_t {
  kNone,        ///< the next step of the same slot
  kTerminated,  ///< nothing
  kTruncated,   ///< more, which the batch does not hold
};

/// What the environments did under one policy. A slot is an environment; row = slot * steps + step.
struct Batch {
  Batch(int slots, int steps, int observation_size, int action_size);

  int slots;
  int steps;  ///< of each slot
  int observation_size;
  int action_size;

  std::vector<float> observations;      // (rows, observation_size) raw, before the step
  std::vector<float> actions;           // (rows, action_size)
  std::vector<float> log_probs;         // (rows) of the actions under the policy that took them
  std::vector<float> rewards;           // (rows)
  std::vector<uint8_t> explored;        // (rows) 0 where the mean action was taken
  std::vector<Ending> endings;          // (rows) the last step of a slot always has one
  std::vector<int> cut_rows;            // (cuts) rows of kTruncated, ascending
  std::vector<float> cut_observations;  // (cuts, observation_size) raw, after those steps

  int rows() const { return slots * steps; }

  // Episodes that ended by themselves.
  int episodes = 0;
  int terminated = 0;     ///< of them
  double return_sum = 0;  ///< of their rewards, undiscounted
  int64_t episode_steps = 0;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_BATCH_H_
