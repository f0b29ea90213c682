#ifndef POISE_CORE_PIPELINE_TRAIN_DEBIAS_SPEC_H_
#define POISE_CORE_PIPELINE_TRAIN_DEBIAS_SPEC_H_

#include "core/correction/debias/debias_config.h"
#include "core/pipeline/training_spec.h"

namespace poise::pipeline {

/// The parameters of a job of kind `train_debias`.
struct TrainDebiasSpec : TrainingSpec {
  /// Errors: those of ReadTrainingSpec and Config, with a field below "spec.parameters".
  static StatusOr<TrainDebiasSpec> FromParameters(const base::Json& parameters);

  /// Errors: those of ConfigOf.
  StatusOr<correction::DebiasConfig> Config() const { return ConfigOf<correction::DebiasConfig>(); }
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_DEBIAS_SPEC_H_
