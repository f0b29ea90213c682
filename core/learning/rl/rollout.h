#ifndef POISE_CORE_LEARNING_RL_ROLLOUT_H_
#define POISE_CORE_LEARNING_RL_ROLLOUT_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/base/thread_pool.h"
#include "core/learning/rl/batch.h"
#include "core/learning/rl/environment.h"
#include "core/learning/rl/policy.h"

namespace poise::rl {

/// How actions leave the policy's mean.
struct Exploration {
  std::vector<float> deviations;  // (actions)
  double share = 1;               ///< of the steps; the others take the mean
};

/// Lets many environments act on a thread pool.
class RolloutCollector {
 public:
  /// `environments` are not empty and alike. Each task of the pool steps `environments_per_task`
  /// of them in turn, so that they share one evaluation of the policy.
  RolloutCollector(std::vector<std::unique_ptr<Environment>> environments,
                   int environments_per_task);

  int slots() const { return static_cast<int>(environments_.size()); }
  int observation_size() const { return environments_.front()->observation_size(); }
  int action_size() const { return environments_.front()->action_size(); }

  /// Fresh episodes everywhere, `steps` steps of each environment. Environment i draws from the
  /// stream DeriveSeed(seed, {i}) and fills slot i: threads change nothing.
  /// Errors: as Ppo::Iterate; of several the one of the first environment.
  StatusOr<Batch> Collect(Policy policy, const Exploration& exploration, int steps, uint64_t seed,
                          base::ThreadPool& pool, const base::RunContext& context);

 private:
  struct SlotSums;
  struct Task;

  Status RunTask(Task task, Batch& batch, std::vector<SlotSums>& sums);
  Status RunStep(Task& task, int slot, int step, Batch& batch, SlotSums& sums);

  std::vector<std::unique_ptr<Environment>> environments_;
  int environments_per_task_;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_ROLLOUT_H_
