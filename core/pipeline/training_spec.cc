#include "core/pipeline/training_spec.h"

#include <fmt/format.h>

#include <utility>

#include "core/api/model_card.h"

namespace poise::pipeline {
namespace {

constexpr const char* kOverrides = "set";

StatusOr<base::Overrides> TakeOverrides(base::Json& parameters) {
  base::Overrides overrides;
  if (!parameters.is_object() || !parameters.contains(kOverrides)) return overrides;
  const base::Json given = parameters[kOverrides];
  parameters.erase(kOverrides);
  if (!given.is_object()) {
    return base::InvalidArgument("MALFORMED_CONFIG_VALUE", kOverrides,
                                 "'set' expects an object of settings");
  }
  for (const auto& [key, value] : given.items()) {
    overrides[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return overrides;
}

}  // namespace

std::string TrainingSpec::DataFingerprint() const {
  return data_artifact.substr(data_artifact.find('/') + 1);
}

std::string TrainingSpec::TrainedOn() const {
  return (action_class.empty() ? "all classes" : "class " + action_class) +
         (hold_out.empty() ? "" : ", without actor " + hold_out);
}

Status ReadTrainingSpec(base::Json parameters, std::vector<base::Field> more, TrainingSpec& spec) {
  POISE_ASSIGN_OR_RETURN(spec.overrides, TakeOverrides(parameters));
  std::vector<base::Field> fields = {base::Text("name", &spec.name),
                                     base::Text("data_artifact", &spec.data_artifact),
                                     base::Text("data", &spec.data),
                                     base::Text("data_license", &spec.data_license),
                                     base::Text("action_class", &spec.action_class),
                                     base::Text("hold_out", &spec.hold_out),
                                     base::Text("preset", &spec.preset)};
  base::Append(fields, std::move(more));
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(parameters, std::move(fields)));
  if (!spec.name.empty()) {
    POISE_RETURN_IF_ERROR(api::CheckResourceName(spec.name, "BAD_MODEL_NAME"));
  }
  if (!spec.data_artifact.empty()) return absl::OkStatus();
  return base::InvalidArgument("MISSING_DATA", "data_artifact",
                               "say what to learn from: the artifact of a data set");
}

}  // namespace poise::pipeline
