#ifndef POISE_CORE_PUSH_TRAINING_TRAIN_NETWORK_H_
#define POISE_CORE_PUSH_TRAINING_TRAIN_NETWORK_H_

#include <optional>
#include <string>

#include "core/learning/nn/trainer.h"
#include "core/push/training/push_training_config.h"

namespace poise::push {

/// How an earlier attempt goes on and where checkpoints go.
struct Resumption {
  std::optional<std::string> checkpoint;  ///< what the earlier attempt handed to `sink`
  learning::CheckpointSink sink;
};

/// One network of this part and how it learns.
struct NetworkTask {
  std::string name;  ///< in progress and learning curve
  std::shared_ptr<torch::nn::Module> module;
  NetworkTraining config;
  int64_t num_samples = 0;
  std::function<StatusOr<learning::Loss>(const learning::Batch&)> loss;
  std::function<StatusOr<double>()> validate;
};

/// Trains it; afterwards it holds the weights that were best on the validation takes.
/// Errors: those of Trainer.
StatusOr<learning::TrainingReport> TrainNetwork(NetworkTask task, const base::RunContext& context,
                                                const Resumption& resumption,
                                                std::string* curve_csv = nullptr);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_TRAIN_NETWORK_H_
