#ifndef POISE_CORE_PUSH_TRAINING_TRAIN_PUSH_H_
#define POISE_CORE_PUSH_TRAINING_TRAIN_PUSH_H_

#include <optional>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/push/takes/push_take.h"
#include "core/push/training/push_training_config.h"

namespace poise::push {

/// What is learned, from what.
struct PushTask {
  const std::vector<PushTake>& takes;  ///< of which the test takes are not looked at
  PushTraining config;
  // For the card:
  std::string preset = "recommended";
  std::string data = {};
  std::string data_fingerprint = {};
  std::string data_license = {};
};

/// What push models move.
motion::MotionSignature PushSignature();

/// MakeLearnedForecaster makes a forecaster of the model, without LibTorch.
struct PushResult {
  artifacts::ModelArtifact model;
  double seconds = 0;     ///< of training, over all attempts
  std::string curve_csv;  ///< the learning curves, one member after the other
};

/// Trains the members of both ensembles one after the other, hips first, each with a seed of its
/// own from that of `context` and with other validation takes, so that together they learn from all
/// training takes. Bodies learn on hips as networks forecast them that did not see the take. With
/// the same seed the weights are the same bit for bit, however often the training was interrupted.
/// The card's scores: `validation_hip_ade_m`, `validation_pose_m`, means over members.
/// Errors: config errors; kInvalidArgument NO_TAKES; kDataLoss CORRUPT_CHECKPOINT; those of
/// Trainer.
StatusOr<PushResult> TrainPush(const PushTask& task, const base::RunContext& context,
                               const std::optional<std::string>& checkpoint = {},
                               const learning::CheckpointSink& sink = {});

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_TRAINING_TRAIN_PUSH_H_
