#ifndef POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_
#define POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_

#include "core/pipeline/training_spec.h"
#include "core/synthesis/vae/vae_config.h"

namespace poise::pipeline {

/// The parameters of a job of kind `train_vae`.
struct TrainVaeSpec : TrainingSpec {
  /// Errors: those of ReadTrainingSpec and Config, with a field below "spec.parameters".
  static StatusOr<TrainVaeSpec> FromParameters(const base::Json& parameters);

  /// Errors: those of ConfigOf.
  StatusOr<synthesis::VaeConfig> Config() const { return ConfigOf<synthesis::VaeConfig>(); }
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_
