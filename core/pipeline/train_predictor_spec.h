#ifndef POISE_CORE_PIPELINE_TRAIN_PREDICTOR_SPEC_H_
#define POISE_CORE_PIPELINE_TRAIN_PREDICTOR_SPEC_H_

#include "core/motion/dataset/benchmark_clips.h"
#include "core/pipeline/training_spec.h"
#include "core/prediction/training/training_config.h"

namespace poise::pipeline {

/// The parameters of a job of kind `train_predictor`.
struct TrainPredictorSpec : TrainingSpec {
  motion::BenchmarkForm form;  ///< "frame_rate" and "body"

  /// Errors: those of ReadTrainingSpec and Config, with a field below "spec.parameters".
  static StatusOr<TrainPredictorSpec> FromParameters(const base::Json& parameters);

  /// Errors: those of ConfigOf.
  StatusOr<prediction::PredictorTraining> Config() const {
    return ConfigOf<prediction::PredictorTraining>();
  }
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_PREDICTOR_SPEC_H_
