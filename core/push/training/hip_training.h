#ifndef POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_
#define POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_

#include <vector>

#include "core/base/config_fields.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/trainer.h"
#include "core/push/takes/fzj_takes.h"
#include "core/push/training/hip_net.h"

namespace poise::push {

/// How the hip network learns: whole roll-outs from frame 0.
struct HipTrainingConfig {
  int64_t steps = 900;            ///< [> 0] of the optimiser
  int batch_size = 8;             ///< [takes]
  double learning_rate = 4e-3;    ///< [> 0] at first; falls along a cosine
  double weight_decay = 1e-3;     ///< [0 to 1]
  double clip_norm = 1;           ///< [> 0] of the gradient
  int first_frames = 30;          ///< [> 1] length of roll-outs at first
  double growing_share = 0.4;     ///< [0 to 1] of the steps in which they grow to all frames
  double velocity_weight = 0.05;  ///< [0 to 10] of hip speed errors beside place errors
  double lean_weight = 0.2;       ///< [0 to 10] of lean errors
  bool mirror = true;             ///< half of the takes change left and right
  int64_t validate_every = 30;    ///< [steps]

  std::vector<base::Field> Fields();
};

/// Mean over takes of the mean distance, over people and frames 1.., of hips in metres.
double HipAde(HipNet net, const TakeBatch& batch);

/// Trains a network on the training takes, chooses its step on the validation takes and returns it
/// with what the trainer reports (best_validation is HipAde).
/// Errors: those of Trainer.
struct TrainedHip {
  HipNet net{nullptr};
  learning::TrainingReport report;
};
StatusOr<TrainedHip> TrainHip(const TrainingTakes& takes, Protocol protocol, const HipConfig& net,
                              const HipTrainingConfig& config, const base::RunContext& context);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_HIP_TRAINING_H_
