#ifndef POISE_CORE_PIPELINE_PUSH_LEARNING_SPEC_H_
#define POISE_CORE_PIPELINE_PUSH_LEARNING_SPEC_H_

#include <string>

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/pipeline/training_spec.h"

namespace poise::pipeline {

/// The parameters of a job of kind `train_push`; data_artifact is a take file
/// (push/takes/take_file.h). Takes have neither classes nor actors to leave out.
struct TrainPushSpec : TrainingSpec {
  /// Errors: those of ReadTrainingSpec and push::CheckPreset, with a field below "spec.parameters";
  /// kInvalidArgument UNKNOWN_CONFIG_KEY for "action_class" and "hold_out".
  static StatusOr<TrainPushSpec> FromParameters(const base::Json& parameters);
};

/// The parameters of a job of kind `evaluate_push`.
struct EvaluatePushSpec {
  std::string data_artifact;   ///< a take file; its test takes are scored
  std::string model_artifact;  ///< a packed model; empty: only what needs no learning
  std::string model;           ///< its name, for the results

  /// Errors: kInvalidArgument with a field below "spec.parameters": UNKNOWN_CONFIG_KEY,
  /// MALFORMED_CONFIG_VALUE, MISSING_DATA.
  static StatusOr<EvaluatePushSpec> FromParameters(const base::Json& parameters);
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_PUSH_LEARNING_SPEC_H_
