#ifndef POISE_CORE_LEARNING_RL_ENVIRONMENT_H_
#define POISE_CORE_LEARNING_RL_ENVIRONMENT_H_

#include <span>

#include "core/base/random.h"
#include "core/base/status.h"

namespace poise::rl {

/// What one action led to.
struct Transition {
  float reward = 0;
  bool terminated = false;  ///< the episode is over and nothing is earned after it (a fall)
  bool truncated = false;   ///< the episode is over, but life would go on (end of time)
};

/// A task with continuous observations and actions, one episode after another.
///
/// An episode may depend only on what Reset draws from `random` and on the actions: then learning
/// is the same whatever thread runs it, and a restored run goes on as the undisturbed one.
/// Threads: one at a time, not always the same one.
class Environment {
 public:
  virtual ~Environment() = default;

  virtual int observation_size() const = 0;
  virtual int action_size() const = 0;

  /// Starts an episode and writes its first observation (observation_size). An episode that was
  /// running is dropped.
  virtual Status Reset(base::Random& random, std::span<float> observation) = 0;

  /// Acts (action_size) and writes the observation after it, also when the episode is over: its
  /// value is needed after a truncation. Call Reset before the next Step then.
  virtual StatusOr<Transition> Step(std::span<const float> action,
                                    std::span<float> observation) = 0;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_ENVIRONMENT_H_
