#ifndef POISE_CORE_PREDICTION_TRAINING_TRAIN_PREDICTOR_H_
#define POISE_CORE_PREDICTION_TRAINING_TRAIN_PREDICTOR_H_

#include <optional>
#include <string>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/motion/dataset/benchmark_clips.h"
#include "core/prediction/training/training_config.h"

namespace poise::prediction {

/// What is learned, from what.
struct PredictorTask {
  motion::BenchmarkClips clips;  ///< of which the test sequences are not looked at
  PredictorTraining config;
  // For the card:
  std::string preset = "recommended";
  std::string data = {};
  std::string data_fingerprint = {};
  std::string data_license = {};
  std::string trained_on = {};
};

/// MakeTrainedPredictor makes a predictor of the model, without LibTorch.
struct PredictorResult {
  artifacts::ModelArtifact model;
  int64_t best_step = -1;  ///< whose weights these are; -1: the last, for lack of held-out data
  double seconds = 0;
  std::string curve_csv;  ///< the learning curve
  std::string curve_svg;
};

/// What a training begins with, for programs that train elsewhere (bench/train_baselines.py).
struct PredictorBeginning {
  artifacts::ModelArtifact model;  ///< before its first step
  /// PoseWindows::AppendTo with "train." and, where some are held out, "validation."; and of the
  /// Euler error that is measured on those: "counts" (3 joints of the body), "row_vectors" (1),
  /// "moving_only" (1).
  base::TensorFile windows;
};

/// Errors: those of TrainPredictor; kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE (windows are not all
/// drawn equally often, or reach over ends: the file would not say so).
StatusOr<PredictorBeginning> BeginPredictor(const PredictorTask& task, uint64_t seed);

/// Learns from the training sequences of a benchmark with the seed of `context`; the weights are
/// those that were best on their held-out ends. `checkpoint` is what an earlier attempt gave to
/// `sink`; with one thread the result is then the same bit for bit.
/// The card's score: `validation_rad`, mean Euler error over held-out windows and frames.
/// Errors: config errors; those of SplitForTraining and learning::Trainer.
StatusOr<PredictorResult> TrainPredictor(const PredictorTask& task, const base::RunContext& context,
                                         const std::optional<std::string>& checkpoint = {},
                                         const learning::CheckpointSink& sink = {});

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_TRAINING_TRAIN_PREDICTOR_H_
