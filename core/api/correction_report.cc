#include "core/api/correction_report.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace poise::api {
namespace {

using base::Json;

constexpr double kAny = std::numeric_limits<double>::max();

Json MeasuresJson(const CorrectionMeasures& measures) {
  Json json = motion::ToJson(measures.plausibility);
  json.update(base::FieldsToJson(CorrectionScore(measures.score).Fields()));
  return json;
}

Status ReadMeasures(const Json& json, CorrectionMeasures& measures) {
  std::vector<base::Field> fields = measures.plausibility.Fields();
  base::Append(fields, measures.score.Fields());
  return base::FieldsFromJson(json, std::move(fields));
}

// Throws what nlohmann throws where something is not as it should be.
StatusOr<CorrectedVariantReport> ReadVariant(const Json& json) {
  CorrectedVariantReport variant;
  if (!json.at("file").is_null()) variant.file = json["file"].get<std::string>();
  variant.index = base::IntegerFrom<int>(json.at("index"));
  variant.seed = base::IntegerFrom<uint64_t>(json.at("seed"));
  variant.completed = json.at("completed").get<bool>();
  variant.effort = json.at("effort").get<std::string>();
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(json.at("before"), variant.before.Fields()));
  if (!json.at("after").is_null()) {
    POISE_RETURN_IF_ERROR(ReadMeasures(json["after"], variant.after.emplace()));
  }
  if (json.contains("error")) {
    const Json& error = json["error"];
    variant.error = JobError{.code = absl::StatusCode::kUnknown,
                             .reason = error.at("reason").get<std::string>(),
                             .message = error.at("message").get<std::string>(),
                             .field = ""};
  }
  return variant;
}

StatusOr<ZeroPolicyReport> ReadZeroPolicy(Json json) {
  ZeroPolicyReport zero;
  zero.completed = json.at("completed").get<bool>();
  json.erase("completed");
  POISE_RETURN_IF_ERROR(ReadMeasures(json, zero.measures));
  return zero;
}

StatusOr<CorrectedClipReport> ReadClip(const Json& json) {
  CorrectedClipReport report;
  report.name = json.at("name").get<std::string>();
  report.samples = base::IntegerFrom<int64_t>(json.at("samples"));
  report.stopped_by = json.at("stopped_by").get<std::string>();
  if (!json.at("zero_policy").is_null()) {
    POISE_ASSIGN_OR_RETURN(report.zero_policy, ReadZeroPolicy(json["zero_policy"]));
  }
  for (const Json& point : json.at("reward_curve")) {
    POISE_RETURN_IF_ERROR(base::FieldsFromJson(point, report.reward_curve.emplace_back().Fields()));
  }
  for (const Json& variant : json.at("variants")) {
    POISE_ASSIGN_OR_RETURN(report.variants.emplace_back(), ReadVariant(variant));
  }
  return report;
}

// Calls `read`, whose errors and exceptions are errors of the report.
template <typename Read>
auto Parse(const Json& json, Read read) -> decltype(read(json)) {
  const auto malformed = [](std::string_view why) {
    return base::InvalidArgument("MALFORMED_REPORT", "report",
                                 fmt::format("the report of a correction is malformed: {}", why));
  };
  try {
    auto report = read(json);
    if (report.ok()) return report;
    return malformed(base::Message(report.status()));
  } catch (const Json::exception& error) {
    return malformed(error.what());
  }
}

}  // namespace

std::vector<base::Field> CorrectionScore::Fields() {
  return {
      base::Number("residual_force_mean_bw", &residual_force_mean_bw, -kAny, kAny),
      base::Number("residual_force_peak_bw", &residual_force_peak_bw, -kAny, kAny),
      base::Number("residual_torque_mean_nm", &residual_torque_mean_nm, -kAny, kAny),
      base::Number("residual_torque_peak_nm", &residual_torque_peak_nm, -kAny, kAny),
      base::Number("torque_saturation", &torque_saturation, -kAny, kAny),
      base::Number("completion", &completion, -kAny, kAny),
      base::Number("reward_imitation", &reward_imitation, -kAny, kAny),
      base::Number("reward_normalised", &reward_normalised, -kAny, kAny),
      base::Number("reward_total", &reward_total, -kAny, kAny),
      base::Number("pose_error_rad", &pose_error_rad, -kAny, kAny),
      base::Number("pose_error_m", &pose_error_m, -kAny, kAny),
  };
}

std::vector<base::Field> RewardPoint::Fields() {
  return {
      base::Number("samples", &samples, 0, std::numeric_limits<int64_t>::max()),
      base::Number("reward_normalised", &reward_normalised, -kAny, kAny),
      base::Number("residual_force_mean_bw", &residual_force_mean_bw, -kAny, kAny),
      base::Number("residual_torque_mean_nm", &residual_torque_mean_nm, -kAny, kAny),
  };
}

base::Json ToJson(const ZeroPolicyReport& report) {
  Json json = {{"completed", report.completed}};
  json.update(MeasuresJson(report.measures));
  return json;
}

base::Json ToJson(const CorrectedVariantReport& variant) {
  Json json = {{"file", variant.file.empty() ? Json(nullptr) : Json(variant.file)},
               {"index", variant.index},
               {"seed", variant.seed},
               {"completed", variant.completed},
               {"effort", variant.effort},
               {"before", motion::ToJson(variant.before)},
               {"after", variant.after ? MeasuresJson(*variant.after) : Json(nullptr)}};
  if (variant.error) {
    json["error"] = {{"code", absl::StatusCodeToString(variant.error->code)},
                     {"reason", variant.error->reason},
                     {"message", variant.error->message}};
  }
  return json;
}

base::Json ToJson(const CorrectedClipReport& report) {
  Json curve = Json::array();
  for (RewardPoint point : report.reward_curve) curve.push_back(base::FieldsToJson(point.Fields()));
  Json variants = Json::array();
  for (const CorrectedVariantReport& variant : report.variants) variants.push_back(ToJson(variant));
  return {{"name", report.name},
          {"samples", report.samples},
          {"stopped_by", report.stopped_by},
          {"zero_policy", report.zero_policy ? ToJson(*report.zero_policy) : Json(nullptr)},
          {"reward_curve", std::move(curve)},
          {"variants", std::move(variants)}};
}

StatusOr<ZeroPolicyReport> ZeroPolicyFromJson(const base::Json& json) {
  return Parse(json, ReadZeroPolicy);
}

StatusOr<CorrectedVariantReport> CorrectedVariantFromJson(const base::Json& json) {
  return Parse(json, ReadVariant);
}

StatusOr<CorrectedClipReport> CorrectedClipFromJson(const base::Json& json) {
  return Parse(json, ReadClip);
}

}  // namespace poise::api
