#include "core/engine/correct_checkpoint.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "core/api/correction_report.h"
#include "core/base/json.h"

namespace poise::engine {
namespace {

using base::Json;

Status Corrupt() {
  return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_CHECKPOINT", "",
                         "the checkpoint is none of this correction");
}

Json CurveJson(const std::vector<api::RewardPoint>& curve) {
  Json json = Json::array();
  for (api::RewardPoint point : curve) json.push_back(base::FieldsToJson(point.Fields()));
  return json;
}

StatusOr<std::vector<api::RewardPoint>> CurveFromJson(const Json& json) {
  std::vector<api::RewardPoint> curve;
  for (const Json& point : json) {
    POISE_RETURN_IF_ERROR(base::FieldsFromJson(point, curve.emplace_back().Fields()));
  }
  return curve;
}

Json PolicyJson(const pipeline::LearnedPolicy& policy) {
  return {{"checkpoint", Json::binary({policy.checkpoint.begin(), policy.checkpoint.end()})},
          {"finished", policy.finished},
          {"stopped_by", policy.stopped_by},
          {"curve", CurveJson(policy.curve)},
          {"samples", policy.samples}};
}

StatusOr<pipeline::LearnedPolicy> PolicyFromJson(const Json& json) {
  pipeline::LearnedPolicy policy;
  const auto& bytes = json.at("checkpoint").get_binary();
  policy.checkpoint.assign(bytes.begin(), bytes.end());
  policy.finished = json.at("finished").get<bool>();
  policy.stopped_by = json.at("stopped_by").get<std::string>();
  POISE_ASSIGN_OR_RETURN(policy.curve, CurveFromJson(json.at("curve")));
  policy.samples = base::IntegerFrom<int64_t>(json.at("samples"));
  return policy;
}

Json VariantJson(const pipeline::CorrectedVariant& variant) {
  return {{"source_index", variant.source_index}, {"report", api::ToJson(variant.report)},
          {"file_data", variant.file_data},       {"curve", CurveJson(variant.curve)},
          {"samples", variant.samples},           {"timed_out", variant.timed_out}};
}

StatusOr<pipeline::CorrectedVariant> VariantFromJson(const Json& json) {
  pipeline::CorrectedVariant variant;
  variant.source_index = base::IntegerFrom<int>(json.at("source_index"));
  POISE_ASSIGN_OR_RETURN(variant.report, api::CorrectedVariantFromJson(json.at("report")));
  variant.file_data = json.at("file_data").get<std::string>();
  POISE_ASSIGN_OR_RETURN(variant.curve, CurveFromJson(json.at("curve")));
  variant.samples = base::IntegerFrom<int64_t>(json.at("samples"));
  variant.timed_out = json.at("timed_out").get<bool>();
  return variant;
}

// Objects of "index" and what is there, of those that are there.
template <typename Value, typename Encode>
Json Present(const std::vector<std::optional<Value>>& values, Encode encode) {
  Json json = Json::array();
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i]) json.push_back({{"index", i}, {"value", encode(*values[i])}});
  }
  return json;
}

template <typename Value, typename Decode>
Status ReadPresent(const Json& json, Decode decode, std::vector<std::optional<Value>>& values) {
  for (const Json& entry : json) {
    const auto index = base::IntegerFrom<size_t>(entry.at("index"));
    if (index >= values.size()) return Corrupt();
    POISE_ASSIGN_OR_RETURN(values[index], decode(entry.at("value")));
  }
  return absl::OkStatus();
}

}  // namespace

std::string EncodeCheckpoint(const pipeline::CorrectState& state) {
  Json policies = Json::array();
  for (const pipeline::LearnedPolicy& policy : state.policies) {
    policies.push_back(PolicyJson(policy));
  }
  const Json json = {{"policies", std::move(policies)},
                     {"zero_policies",
                      Present(state.zero_policies,
                              [](const api::ZeroPolicyReport& zero) { return api::ToJson(zero); })},
                     {"variants", Present(state.variants, VariantJson)},
                     {"seconds", state.seconds}};
  // Binary: exact numbers, and files as they are.
  std::string bytes;
  Json::to_cbor(json, bytes);
  return bytes;
}

StatusOr<pipeline::CorrectState> DecodeCheckpoint(std::string_view bytes,
                                                  pipeline::CorrectState empty) {
  try {
    const Json json = Json::from_cbor(bytes);
    if (json.at("policies").size() != empty.policies.size()) return Corrupt();
    for (size_t i = 0; i < empty.policies.size(); ++i) {
      POISE_ASSIGN_OR_RETURN(empty.policies[i], PolicyFromJson(json["policies"][i]));
    }
    POISE_RETURN_IF_ERROR(
        ReadPresent(json.at("zero_policies"), api::ZeroPolicyFromJson, empty.zero_policies));
    POISE_RETURN_IF_ERROR(ReadPresent(json.at("variants"), VariantFromJson, empty.variants));
    empty.seconds = json.at("seconds").get<double>();
    return empty;
  } catch (const Json::exception&) {
    return Corrupt();
  }
}

}  // namespace poise::engine
