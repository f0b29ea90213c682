#include "core/pipeline/train_vae_spec.h"

#include "core/api/model_card.h"
#include "core/pipeline/settings_of_spec.h"

namespace poise::pipeline {
namespace {

std::vector<base::Field> Fields(TrainVaeSpec& spec) {
  return {base::Text("name", &spec.name),
          base::Text("data_artifact", &spec.data_artifact),
          base::Text("data", &spec.data),
          base::Text("data_license", &spec.data_license),
          base::Text("action_class", &spec.action_class),
          base::Text("hold_out", &spec.hold_out),
          base::Text("preset", &spec.preset)};
}

StatusOr<TrainVaeSpec> Parse(base::Json parameters) {
  TrainVaeSpec spec;
  POISE_ASSIGN_OR_RETURN(spec.overrides, TakeSettings(parameters));
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(parameters, Fields(spec)));
  if (!spec.name.empty()) {
    POISE_RETURN_IF_ERROR(api::CheckResourceName(spec.name, "BAD_MODEL_NAME"));
  }
  if (spec.data_artifact.empty()) {
    return base::InvalidArgument("MISSING_DATA", "data_artifact",
                                 "say what to learn from: the artifact of a data set");
  }
  POISE_RETURN_IF_ERROR(spec.Config().status());
  return spec;
}

}  // namespace

StatusOr<TrainVaeSpec> TrainVaeSpec::FromParameters(const base::Json& parameters) {
  StatusOr<TrainVaeSpec> spec = Parse(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), "train_vae", "spec.parameters");
  return spec;
}

StatusOr<synthesis::VaeConfig> TrainVaeSpec::Config() const {
  POISE_ASSIGN_OR_RETURN(synthesis::VaeConfig config, synthesis::VaeConfig::FromPreset(preset));
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
  return config;
}

}  // namespace poise::pipeline
