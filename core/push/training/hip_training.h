#ifndef POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_
#define POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_

#include <map>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/hip_net.h"
#include "core/push/training/train_network.h"

namespace poise::push {

/// Mean over takes of the mean distance, over people and frames 1.., of hips in metres.
double HipAde(HipNet net, const TakeBatch& batch);

/// Trains a network on the training takes, chooses its step on the validation takes and returns it
/// with what the trainer reports (best_validation is HipAde).
/// Errors: those of Trainer.
struct TrainedHip {
  HipNet net{nullptr};
  learning::TrainingReport report;
  std::string curve_csv;
};
StatusOr<TrainedHip> TrainHip(const TrainingTakes& takes, Protocol protocol, const HipConfig& net,
                              const HipTraining& config, const base::RunContext& context,
                              const Resumption& resumption = {});

/// Paths of takes' people, (people, frames, 2).
using HipForecasts = std::map<const PushTake*, HipPaths>;

/// Adds what a network forecasts of takes, `ahead` frames beyond the recorded ones.
void AddForecasts(HipNet net, const std::vector<const PushTake*>& takes, Protocol protocol,
                  int64_t ahead, base::Random& random, HipForecasts& forecasts);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_
