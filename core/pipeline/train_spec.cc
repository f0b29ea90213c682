#include "core/pipeline/train_spec.h"

#include "core/api/model_card.h"
#include "core/correction/debias/debias_config.h"
#include "core/synthesis/vae/vae_config.h"

namespace poise::pipeline {
namespace {

constexpr const char* kOverrides = "set";

std::vector<base::Field> Fields(TrainSpec& spec) {
  return {base::Text("name", &spec.name),
          base::Text("data_artifact", &spec.data_artifact),
          base::Text("data", &spec.data),
          base::Text("data_license", &spec.data_license),
          base::Text("action_class", &spec.action_class),
          base::Text("hold_out", &spec.hold_out),
          base::Text("preset", &spec.preset)};
}

StatusOr<TrainSpec> Parse(base::Json parameters) {
  TrainSpec spec;
  if (parameters.is_object() && parameters.contains(kOverrides)) {
    const base::Json overrides = parameters[kOverrides];
    parameters.erase(kOverrides);
    if (!overrides.is_object()) {
      return base::InvalidArgument("MALFORMED_CONFIG_VALUE", kOverrides,
                                   "'set' expects an object of settings");
    }
    for (const auto& [key, value] : overrides.items()) {
      spec.overrides[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(parameters, Fields(spec)));
  if (!spec.name.empty()) {
    POISE_RETURN_IF_ERROR(api::CheckResourceName(spec.name, "BAD_MODEL_NAME"));
  }
  if (spec.data_artifact.empty()) {
    return base::InvalidArgument("MISSING_DATA", "data_artifact",
                                 "say what to learn from: the artifact of a data set");
  }
  return spec;
}

template <typename Config>
Status Check(const base::Json& parameters, std::string_view kind) {
  POISE_ASSIGN_OR_RETURN(const TrainSpec spec, TrainSpec::FromParameters(parameters, kind));
  return base::Annotate(spec.ConfigOf<Config>().status(), kind, "spec.parameters");
}

}  // namespace

StatusOr<TrainSpec> TrainSpec::FromParameters(const base::Json& parameters, std::string_view kind) {
  StatusOr<TrainSpec> spec = Parse(parameters);
  if (!spec.ok()) return base::Annotate(spec.status(), kind, "spec.parameters");
  return spec;
}

Status CheckTrainVae(const base::Json& parameters) {
  return Check<synthesis::VaeConfig>(parameters, "train_vae");
}

Status CheckTrainDebias(const base::Json& parameters) {
  return Check<correction::DebiasConfig>(parameters, "train_debias");
}

}  // namespace poise::pipeline
