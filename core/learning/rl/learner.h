#ifndef POISE_CORE_LEARNING_RL_LEARNER_H_
#define POISE_CORE_LEARNING_RL_LEARNER_H_

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/base/tensor_file.h"
#include "core/base/thread_pool.h"
#include "core/learning/rl/batch.h"
#include "core/learning/rl/policy.h"
#include "core/learning/rl/ppo.h"
#include "core/learning/rl/ppo_config.h"
#include "core/learning/rl/rollout.h"
#include "core/learning/rl/running_moments.h"
#include "core/learning/rl/trainable_mlp.h"

namespace poise::rl {

/// All that PPO learns, and how it learns from a batch. The environments stay outside.
/// Threads: one caller at a time.
class Learner {
 public:
  /// `config` is valid.
  Learner(int observation_size, int action_size, const PpoConfig& config, uint64_t seed);

  int64_t iterations() const { return iterations_; }
  int64_t samples() const { return samples_; }

  StatusOr<Policy> MakePolicy() const;
  /// What the schedules say at this number of samples.
  Exploration exploration() const;

  /// Only measures the observations.
  void Observe(const Batch& batch);

  /// One update; fills what concerns learning in `report`. A failed update leaves this half done.
  /// Errors: as Ppo::Iterate.
  Status Update(const Batch& batch, base::ThreadPool& pool, const base::RunContext& context,
                IterationReport& report);

  /// A copy that shares nothing.
  Learner Clone() const;

  void Save(base::TensorFile& file) const;
  /// Errors: kInvalidArgument. Some may be restored then.
  Status Restore(const base::TensorFile& file);

 private:
  // The batch as tensors.
  struct Samples {
    at::Tensor observations;              // (rows, observation_size) scaled
    at::Tensor actions;                   // (rows, action_size)
    at::Tensor log_probs;                 // (rows)
    at::Tensor weights;                   // (rows)
    at::Tensor advantages;                // (rows) standardised
    at::Tensor targets;                   // (rows, 1) of the critic's output
    std::vector<at::Tensor> minibatches;  // rows of each, epoch after epoch
  };

  double learning_rate_factor() const;
  at::Tensor log_deviations() const;  // (actions)
  // What the critic's output stands for: value = offset + scale * output.
  struct ValueScale {
    double offset = 0;
    double scale = 1;
  };
  ValueScale value_scale() const;

  std::vector<std::pair<std::string, at::Tensor>> Sums() const;
  Samples Prepare(const Batch& batch, IterationReport& report);
  void Rescale(std::span<const float> returns);
  std::vector<at::Tensor> Shuffle(int rows) const;
  Status TrainActor(const Samples& samples, const base::RunContext& context,
                    IterationReport& report);
  Status TrainCritic(const Samples& samples, const base::RunContext& context);

  PpoConfig config_;
  uint64_t seed_;
  TrainableMlp actor_;  // its tail: logarithms of the actions' deviations, where they are learned
  TrainableMlp critic_;
  RunningMoments observations_;
  RunningMoments returns_;
  int64_t iterations_ = 0;
  int64_t samples_ = 0;
};

}  // namespace poise::rl

#endif  // POISE_CORE_LEARNING_RL_LEARNER_H_
