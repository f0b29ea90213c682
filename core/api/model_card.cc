#include "core/api/model_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <type_traits>

namespace poise::api {
namespace {

constexpr size_t kMaxNameLength = 64;

// Reads `key` into `value`; the error names the key.
template <typename Value>
Status Read(const base::Json& json, const char* key, Value& value) {
  try {
    if constexpr (std::is_integral_v<Value>) {
      value = base::IntegerFrom<Value>(json.at(key));
    } else {
      value = json.at(key).get<Value>();
    }
    return absl::OkStatus();
  } catch (const base::Json::exception&) {
    return base::InvalidArgument(
        "MALFORMED_CARD", key, fmt::format("model card: '{}' is missing or of a wrong type", key));
  }
}

bool IsNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

}  // namespace

base::Json ToJson(const ModelCard& card) {
  return {{"family", card.family},
          {"preset", card.preset},
          {"config", card.config},
          {"signature", motion::ToJson(card.signature)},
          {"normalisation", card.normalisation},
          {"data", card.data},
          {"data_fingerprint", card.data_fingerprint},
          {"trained_on", card.trained_on},
          {"data_license", card.data_license},
          {"seed", card.seed},
          {"steps", card.steps},
          {"scores", card.scores},
          {"program_version", card.program_version},
          {"weights_sha256", card.weights_sha256}};
}

StatusOr<ModelCard> ModelCardFromJson(const base::Json& json) {
  ModelCard card;
  base::Json signature;
  POISE_RETURN_IF_ERROR(Read(json, "family", card.family));
  POISE_RETURN_IF_ERROR(Read(json, "preset", card.preset));
  POISE_RETURN_IF_ERROR(Read(json, "config", card.config));
  POISE_RETURN_IF_ERROR(Read(json, "signature", signature));
  POISE_RETURN_IF_ERROR(Read(json, "normalisation", card.normalisation));
  POISE_RETURN_IF_ERROR(Read(json, "data", card.data));
  POISE_RETURN_IF_ERROR(Read(json, "data_fingerprint", card.data_fingerprint));
  POISE_RETURN_IF_ERROR(Read(json, "trained_on", card.trained_on));
  POISE_RETURN_IF_ERROR(Read(json, "data_license", card.data_license));
  POISE_RETURN_IF_ERROR(Read(json, "seed", card.seed));
  POISE_RETURN_IF_ERROR(Read(json, "steps", card.steps));
  POISE_RETURN_IF_ERROR(Read(json, "scores", card.scores));
  POISE_RETURN_IF_ERROR(Read(json, "program_version", card.program_version));
  POISE_RETURN_IF_ERROR(Read(json, "weights_sha256", card.weights_sha256));
  POISE_ASSIGN_OR_RETURN(card.signature, motion::SignatureFromJson(signature));
  return card;
}

Status CheckResourceName(std::string_view name, std::string_view reason) {
  const bool good = !name.empty() && name.size() <= kMaxNameLength &&
                    std::all_of(name.begin(), name.end(), IsNameCharacter) &&
                    std::isalnum(static_cast<unsigned char>(name[0]));
  if (good) return absl::OkStatus();
  return base::InvalidArgument(
      reason, "name",
      fmt::format("'{}' is no name: expected 1 to {} of a-z, 0-9, '-', '_' and '.', beginning with "
                  "a letter or a digit",
                  name.substr(0, 2 * kMaxNameLength), kMaxNameLength));
}

StatusOr<ModelReference> ModelReference::Parse(std::string_view text) {
  ModelReference reference;
  const size_t at = text.find('@');
  reference.name = text.substr(0, at);
  POISE_RETURN_IF_ERROR(CheckResourceName(reference.name, "BAD_MODEL_NAME"));
  if (at == std::string_view::npos) return reference;
  reference.version = text.substr(at + 1);
  POISE_RETURN_IF_ERROR(CheckResourceName(reference.version, "BAD_MODEL_NAME"));
  return reference;
}

base::Json ToJson(const Model& model) {
  return {
      {"name", model.name},       {"version", model.version},       {"default", model.is_default},
      {"shipped", model.shipped}, {"size_bytes", model.size_bytes}, {"card", ToJson(model.card)}};
}

}  // namespace poise::api
