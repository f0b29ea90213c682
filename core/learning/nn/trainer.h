#ifndef POISE_CORE_LEARNING_NN_TRAINER_H_
#define POISE_CORE_LEARNING_NN_TRAINER_H_

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/random.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/learning/nn/learning_curve.h"
#include "core/learning/nn/trainer_config.h"

namespace poise::learning {

/// What one step learns from.
struct Batch {
  int64_t step = 0;                  ///< from 0
  std::span<const int64_t> samples;  ///< indices into the training set
  base::Random& random;  ///< of this step, for whatever else is drawn (crops, noise on inputs)
};

/// What a network is told about a batch.
struct Loss {
  torch::Tensor total;                       ///< scalar with a gradient: is made small
  std::map<std::string, double> terms = {};  ///< what it consists of, for the learning curve
};

/// One set of weights with its own optimiser. A plain model is one of them; a generator and its
/// discriminators are several, updated one after the other in each step, on the same batch. A loss
/// may go through other networks' modules: their gradients are cleared before they learn.
struct TrainedNetwork {
  std::string name;
  std::shared_ptr<torch::nn::Module> module;
  OptimizerConfig optimizer;
  /// Called in training mode. LibTorch's generator is seeded before each step, so dropout and noise
  /// are the same after a resume.
  std::function<StatusOr<Loss>(const Batch&)> loss;
};

struct TrainingSetup {
  std::vector<TrainedNetwork> networks = {};
  int64_t num_samples = 0;  ///< size of the training set
  /// Score on held-out data, lower is better; called in evaluation mode, without gradients. Empty:
  /// no early stopping, and the last weights are the result.
  std::function<StatusOr<double>()> validate = {};
  uint64_t seed = 0;
};

struct TrainingReport {
  int64_t steps = 0;       ///< done, over all attempts
  int64_t best_step = -1;  ///< after which validation was best; -1 without validation
  double best_validation = std::numeric_limits<double>::infinity();
  double seconds = 0;      ///< over all attempts
  std::string stopped_by;  ///< steps | patience | max_seconds
};

/// Trains networks that it knows nothing about. With one thread, the same setup, config and seed
/// give the same weights bit for bit, however often the run was interrupted: data order and noise
/// are functions of seed and step, everything else is in the checkpoint.
/// Threads: one trainer at a time in a process (it seeds LibTorch's generator).
class Trainer {
 public:
  /// Errors: config errors; kInvalidArgument NO_SAMPLES, NO_NETWORKS.
  static StatusOr<std::unique_ptr<Trainer>> Create(TrainingSetup setup,
                                                   const TrainerConfig& config);
  ~Trainer();

  /// Trains to the end. With validation the networks then hold the best weights, else the last.
  /// Progress: step of steps, every term's recent mean, "validation", "best_validation", "eta_s".
  /// Asked to stop, it hands a checkpoint to `sink` first.
  /// Errors: kCancelled, kDeadlineExceeded; kOutOfRange NOT_FINITE naming the loss term, gradient
  /// or weight; those of the callbacks; NETWORK_FAILED when LibTorch throws.
  StatusOr<TrainingReport> Run(const base::RunContext& context, const CheckpointSink& sink = {});

  /// Weights, best weights, optimisers, step, curve: a tensor file (base/tensor_file.h).
  StatusOr<std::string> Checkpoint() const;
  /// Errors: kDataLoss CORRUPT_CHECKPOINT; kFailedPrecondition CHECKPOINT_MISMATCH when it is of
  /// another config, seed or training set, naming what differs.
  Status Restore(std::string_view checkpoint);

  const LearningCurve& curve() const;

 private:
  class Implementation;
  explicit Trainer(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// Seeds LibTorch's generator, from which new modules draw their first weights.
void SeedTorch(uint64_t seed);

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_TRAINER_H_
