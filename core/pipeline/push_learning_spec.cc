#include "core/pipeline/push_learning_spec.h"

#include "core/push/presets/check_preset.h"

namespace poise::pipeline {
namespace {

StatusOr<TrainPushSpec> ParseTraining(const base::Json& parameters) {
  TrainPushSpec spec;
  POISE_RETURN_IF_ERROR(ReadTrainingSpec(parameters, {}, spec));
  if (!spec.action_class.empty() || !spec.hold_out.empty()) {
    return base::InvalidArgument("UNKNOWN_CONFIG_KEY",
                                 spec.hold_out.empty() ? "action_class" : "hold_out",
                                 "recorded pushes have neither classes nor actors");
  }
  POISE_RETURN_IF_ERROR(push::CheckPreset(spec.preset, spec.overrides));
  return spec;
}

StatusOr<EvaluatePushSpec> ParseEvaluation(const base::Json& parameters) {
  EvaluatePushSpec spec;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(
      parameters,
      {base::Text("data_artifact", &spec.data_artifact),
       base::Text("model_artifact", &spec.model_artifact), base::Text("model", &spec.model)}));
  if (!spec.data_artifact.empty()) return spec;
  return base::InvalidArgument("MISSING_DATA", "data_artifact",
                               "say what to score: the artifact of a take file");
}

}  // namespace

StatusOr<TrainPushSpec> TrainPushSpec::FromParameters(const base::Json& parameters) {
  StatusOr<TrainPushSpec> spec = ParseTraining(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), "train_push", "spec.parameters");
  return spec;
}

StatusOr<EvaluatePushSpec> EvaluatePushSpec::FromParameters(const base::Json& parameters) {
  StatusOr<EvaluatePushSpec> spec = ParseEvaluation(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), "evaluate_push", "spec.parameters");
  return spec;
}

}  // namespace poise::pipeline
