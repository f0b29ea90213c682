#ifndef POISE_CORE_LEARNING_RL_PPO_H_
#define POISE_CORE_LEARNING_RL_PPO_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/rl/environment.h"
#include "core/learning/rl/policy.h"
#include "core/learning/rl/ppo_config.h"

namespace poise::rl {

/// What one iteration saw and did.
struct IterationReport {
  int64_t iteration = 0;       ///< from 1
  int64_t samples = 0;         ///< of the whole training so far, warm-up included
  double reward_mean = 0;      ///< per step of the batch, with exploration
  double episode_return = 0;   ///< mean undiscounted sum over the episodes that ended
  double episode_length = 0;   ///< [steps] their mean
  int episodes = 0;            ///< that ended by themselves, not with the batch
  int terminated = 0;          ///< of them, those that failed
  double noise = 0;            ///< mean standard deviation of the actions
  double kl = 0;               ///< [nats] from the old policy to the new, on the last minibatch
  double clip_fraction = 0;    ///< share of ratios outside 1 +- clip, mean of the update
  double value_error = 0;      ///< 1 - explained variance of the returns, before the update
  double actor_gradient = 0;   ///< mean norm before clipping
  int actor_steps = 0;         ///< minibatches before the divergence stopped them
  double collect_seconds = 0;  ///< wall time in the environments
  double update_seconds = 0;   ///< wall time of learning
};

/// Learns a policy for `environments`, all of the same task, on CPU.
///
/// An iteration starts fresh episodes everywhere, collects a batch, learns from it, and forgets it.
/// Episodes that run when the batch is full are cut there (their rest is estimated by the value
/// function, as after any truncation). So nothing of an environment outlives an iteration, and a
/// restored run is the undisturbed one, bit for bit; the price is a reset per environment and
/// iteration, and episodes longer than samples_per_update / environments must not all start at
/// their beginning, or their ends are never seen.
///
/// Results depend on config, seed and number of environments, not on threads: each environment
/// draws from a stream of its own per iteration and fills its own slot of the batch, and each
/// network is updated by one thread.
/// Threads: one caller at a time.
class Ppo {
 public:
  /// Errors: those of PpoConfig::Validate; kInvalidArgument NO_ENVIRONMENT, ENVIRONMENTS_DIFFER.
  static StatusOr<Ppo> Create(std::vector<std::unique_ptr<Environment>> environments,
                              const PpoConfig& config, uint64_t seed);
  Ppo(Ppo&&) noexcept;
  Ppo& operator=(Ppo&&) noexcept;
  ~Ppo();

  /// One batch and one update. On any error all is as before the call, so it may be repeated.
  /// Errors: those of the environments; kCancelled, kDeadlineExceeded of `context`; kOutOfRange
  /// NOT_FINITE with the tensor's name when an observation, a reward or a weight is not finite.
  StatusOr<IterationReport> Iterate(const base::RunContext& context = {});

  /// What is learned so far.
  Policy policy() const;

  int64_t iterations() const;
  int64_t samples() const;

  /// Weights, optimisers, normalisers and counters. The environments hold no state to save.
  std::string Save() const;

  /// Goes on where the run that saved `bytes` stood.
  /// Errors: kInvalidArgument MALFORMED_CHECKPOINT; kFailedPrecondition CHECKPOINT_DIFFERS when it
  /// comes from another config, seed, task or number of environments. Nothing changes then.
  Status Restore(std::string_view bytes);

 private:
  struct State;
  explicit Ppo(std::unique_ptr<State> state);

  std::unique_ptr<State> state_;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_PPO_H_
