#include "core/pipeline/push_learning_spec.h"

#include "core/api/model_card.h"
#include "core/pipeline/settings_of_spec.h"

namespace poise::pipeline {
namespace {

Status NoData(const std::string& what) {
  return base::InvalidArgument("MISSING_DATA", "data_artifact",
                               "say what to " + what + ": the artifact of a take file");
}

StatusOr<TrainPushSpec> ParseTraining(base::Json parameters) {
  TrainPushSpec spec;
  POISE_ASSIGN_OR_RETURN(spec.overrides, TakeSettings(parameters));
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(
      parameters, {base::Text("name", &spec.name), base::Text("data_artifact", &spec.data_artifact),
                   base::Text("data", &spec.data), base::Text("data_license", &spec.data_license),
                   base::Text("preset", &spec.preset)}));
  if (!spec.name.empty()) {
    POISE_RETURN_IF_ERROR(api::CheckResourceName(spec.name, "BAD_MODEL_NAME"));
  }
  if (spec.data_artifact.empty()) return NoData("learn from");
  POISE_RETURN_IF_ERROR(spec.Config().status());
  return spec;
}

StatusOr<EvaluatePushSpec> ParseEvaluation(const base::Json& parameters) {
  EvaluatePushSpec spec;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(
      parameters,
      {base::Text("data_artifact", &spec.data_artifact),
       base::Text("model_artifact", &spec.model_artifact), base::Text("model", &spec.model)}));
  if (spec.data_artifact.empty()) return NoData("score");
  return spec;
}

}  // namespace

StatusOr<TrainPushSpec> TrainPushSpec::FromParameters(const base::Json& parameters) {
  StatusOr<TrainPushSpec> spec = ParseTraining(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), "train_push", "spec.parameters");
  return spec;
}

StatusOr<push::PushTraining> TrainPushSpec::Config() const {
  POISE_ASSIGN_OR_RETURN(push::PushTraining config, push::PushTraining::FromPreset(preset));
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  return config;
}

StatusOr<EvaluatePushSpec> EvaluatePushSpec::FromParameters(const base::Json& parameters) {
  StatusOr<EvaluatePushSpec> spec = ParseEvaluation(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), "evaluate_push", "spec.parameters");
  return spec;
}

}  // namespace poise::pipeline
