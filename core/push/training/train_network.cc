#include "core/push/training/train_network.h"

#include <utility>

namespace poise::push {

StatusOr<learning::TrainingReport> TrainNetwork(NetworkTask task, const base::RunContext& context,
                                                const Resumption& resumption,
                                                std::string* curve_csv) {
  const NetworkTraining& config = task.config;
  learning::TrainingSetup setup{
      .num_samples = task.num_samples, .validate = std::move(task.validate), .seed = context.seed};
  setup.networks.push_back({.name = std::move(task.name),
                            .module = std::move(task.module),
                            .optimizer = {.type = "adamw",
                                          .learning_rate = config.learning_rate,
                                          .weight_decay = config.weight_decay,
                                          .schedule = "cosine",
                                          .clip_norm = config.clip_norm},
                            .loss = std::move(task.loss)});
  POISE_ASSIGN_OR_RETURN(
      const auto trainer,
      learning::Trainer::Create(std::move(setup), {.steps = config.steps,
                                                   .batch_size = config.batch_size,
                                                   .validate_every = config.validate_every}));
  if (resumption.checkpoint) POISE_RETURN_IF_ERROR(trainer->Restore(*resumption.checkpoint));
  POISE_ASSIGN_OR_RETURN(const learning::TrainingReport report,
                         trainer->Run(context, resumption.sink));
  if (curve_csv != nullptr) *curve_csv = trainer->curve().ToCsv();
  return report;
}

}  // namespace poise::push
