#include "core/api/correct_spec.h"

#include <fmt/format.h>

#include <utility>

namespace poise::api {
namespace {

using base::Json;

constexpr int kUsualVariants = 20;
constexpr double kLightestBody = 5;  // [kg]
constexpr double kHeaviestBody = 500;
constexpr double kLongestRun = 1e7;  // [s]

Json ToJson(const ClipSource& source) {
  const auto& stored = std::get<StoredClip>(source.clip);
  Json json = {{"artifact", stored.artifact}, {"name", stored.name}};
  if (stored.format != motion::ClipFormat::kUnknown) {
    json["format"] = motion::ClipFormatName(stored.format);
  }
  if (!stored.skeleton_data.empty()) json["skeleton_data"] = stored.skeleton_data;
  if (stored.hints.unit_m) json["unit_m"] = *stored.hints.unit_m;
  if (stored.hints.up) json["up"] = *stored.hints.up == motion::UpAxis::kY ? "y" : "z";
  if (stored.hints.frame_rate) json["frame_rate"] = *stored.hints.frame_rate;
  for (const auto& [role, joint] : source.joint_roles) json["joint_roles"][role] = joint;
  return json;
}

// The hints, from what their fields say; 0 and "" are absent.
motion::ClipHints Hints(double unit_m, const std::string& up, double frame_rate) {
  motion::ClipHints hints;
  if (unit_m > 0) hints.unit_m = unit_m;
  if (frame_rate > 0) hints.frame_rate = frame_rate;
  if (!up.empty()) hints.up = up == "y" ? motion::UpAxis::kY : motion::UpAxis::kZ;
  return hints;
}

StatusOr<ClipSource> SourceFromJson(Json json) {
  if (!json.is_object() || !json.contains("artifact") || !json.contains("name")) {
    return base::InvalidArgument("MALFORMED_SOURCE", "",
                                 "a source is an object with 'artifact' and 'name'");
  }
  ClipSource source{.clip = StoredClip(), .joint_roles = {}};
  if (json.contains("joint_roles")) {
    POISE_ASSIGN_OR_RETURN(source.joint_roles,
                           motion::JointRoles::ParseOverrides(json["joint_roles"].dump()));
    json.erase("joint_roles");
  }
  StoredClip stored;
  std::string format;
  std::string up;
  double unit_m = 0;
  double frame_rate = 0;
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(
      json, {base::Text("artifact", &stored.artifact), base::Text("name", &stored.name),
             base::Text("format", &format), base::Text("skeleton_data", &stored.skeleton_data),
             base::Number("unit_m", &unit_m, 1e-6, 1e3), base::Text("up", &up, {"y", "z"}),
             base::Number("frame_rate", &frame_rate, 1e-3, 1e4)}));
  if (!format.empty()) {
    POISE_ASSIGN_OR_RETURN(stored.format, motion::ParseClipFormat(format));
  }
  stored.hints = Hints(unit_m, up, frame_rate);
  source.clip = std::move(stored);
  return source;
}

StatusOr<std::vector<ClipSource>> SourcesFromJson(const Json& json) {
  if (!json.is_array()) {
    return base::InvalidArgument("MALFORMED_SOURCE", "sources", "sources is an array");
  }
  std::vector<ClipSource> sources;
  for (const Json& element : json) {
    StatusOr<ClipSource> source = SourceFromJson(element);
    const std::string field = fmt::format("sources[{}]", sources.size());
    if (!source.ok()) return base::Annotate(source.status(), field, field);
    sources.push_back(*std::move(source));
  }
  return sources;
}

StatusOr<base::Overrides> OverridesFromJson(const Json& json) {
  if (!json.is_object()) {
    return base::InvalidArgument("MALFORMED_CONFIG_VALUE", "overrides",
                                 "overrides is an object of names and values");
  }
  base::Overrides overrides;
  for (const auto& [key, value] : json.items()) {
    overrides[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return overrides;
}

}  // namespace

int CorrectSpec::Variants() const {
  if (variants_per_source > 0) return variants_per_source;
  return method == "none" ? 1 : kUsualVariants;
}

std::vector<base::Field> CorrectSpec::Fields() {
  return {
      base::Text("method", &method),
      base::Text("action_class", &action_class),
      base::Text("model", &model),
      base::Text("model_artifact", &model_artifact),
      base::Text("debias", &debias),
      base::Text("debias_artifact", &debias_artifact),
      base::Number("variants_per_source", &variants_per_source, 0, kMaxVariants),
      base::Text("effort", &effort, {"instant", "fast", "full"}),
      base::Text("preset", &preset, {"recommended", "paper"}),
      base::Text("residual", &residual, {"none", "rfc", "pd", "pd_rfc"}),
      base::Number("max_seconds", &max_seconds, 0, kLongestRun),
      base::Number("body_mass_kg", &body_mass_kg, 0, kHeaviestBody),
  };
}

Status CorrectSpec::Validate() const {
  if (sources.empty()) {
    return base::InvalidArgument("EMPTY_REQUEST", "sources",
                                 "sources is empty: nothing to correct");
  }
  if (sources.size() > kMaxSources) {
    return base::InvalidArgument(
        "TOO_MANY_SOURCES", "sources",
        fmt::format("request has {} sources, at most {}", sources.size(), kMaxSources));
  }
  POISE_RETURN_IF_ERROR(base::CheckRanges(CorrectSpec(*this).Fields()));
  if (method == "none" && variants_per_source > 1) {
    return base::InvalidArgument(
        "BAD_VARIANT_COUNT", "variants_per_source",
        fmt::format("variants_per_source is {}, but the method none makes one: the clip itself",
                    variants_per_source));
  }
  if (body_mass_kg != 0 && body_mass_kg < kLightestBody) {
    return base::InvalidArgument("CONFIG_VALUE_OUT_OF_RANGE", "body_mass_kg",
                                 fmt::format("body_mass_kg is {}, expected {} to {}, or 0 for the "
                                             "preset's",
                                             body_mass_kg, kLightestBody, kHeaviestBody));
  }
  if (effort != "full" && (residual == "rfc" || residual == "pd_rfc")) {
    return base::InvalidArgument(
        "RESIDUAL_NEEDS_LEARNING", "residual",
        fmt::format("residual {} is a force that is learned, which effort {} does not do: use "
                    "effort full, or residual pd",
                    residual, effort));
  }
  return absl::OkStatus();
}

base::Json CorrectSpec::ToJson() const {
  Json json = {{"sources", Json::array()}};
  for (const ClipSource& source : sources) json["sources"].push_back(api::ToJson(source));
  json.update(base::FieldsToJson(CorrectSpec(*this).Fields()));
  json["overrides"] = Json::object();
  for (const auto& [key, value] : overrides) json["overrides"][key] = value;
  return json;
}

StatusOr<CorrectSpec> CorrectSpec::FromJson(const base::Json& json) {
  CorrectSpec spec;
  Json scalars = json;
  if (json.is_object() && json.contains("sources")) {
    POISE_ASSIGN_OR_RETURN(spec.sources, SourcesFromJson(json["sources"]));
    scalars.erase("sources");
  }
  if (json.is_object() && json.contains("overrides")) {
    POISE_ASSIGN_OR_RETURN(spec.overrides, OverridesFromJson(json["overrides"]));
    scalars.erase("overrides");
  }
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(scalars, spec.Fields()));
  POISE_RETURN_IF_ERROR(spec.Validate());
  return spec;
}

}  // namespace poise::api
