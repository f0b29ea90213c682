#include "core/runtime/jobs/job_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/sha256.h"

namespace poise::jobs {
namespace {

using api::JobArtifact;
using api::JobCheckpoint;
using api::JobError;
using api::JobLimits;
using base::Json;
using base::Progress;

// A duration of at least a millisecond; an infinite one is left out.
void PutDuration(Json& json, const char* key, absl::Duration duration) {
  if (duration == absl::InfiniteDuration()) return;
  json[key] = std::max<int64_t>(1, absl::ToInt64Milliseconds(duration));
}

absl::Duration GetDuration(const Json& json, const char* key) {
  return json.contains(key) ? absl::Milliseconds(base::IntegerFrom<int64_t>(json.at(key)))
                            : absl::InfiniteDuration();
}

// Calls `read` on the parsed text; what it does not find there is a fault of the file.
template <typename Read>
auto Parse(std::string_view text, Read read) -> StatusOr<decltype(read(Json()))> {
  POISE_ASSIGN_OR_RETURN(const Json json, ParseStored(text));
  try {
    return read(json);
  } catch (const Json::exception& error) {
    return base::MakeError(absl::StatusCode::kDataLoss, "STORE_CORRUPT", "",
                           fmt::format("a job's stored text is damaged: {}", error.what()));
  }
}

Json ArtifactsToJson(const std::vector<JobArtifact>& artifacts) {
  Json list = Json::array();
  for (const JobArtifact& artifact : artifacts) {
    list.push_back({{"name", artifact.name},
                    {"artifact", artifact.artifact},
                    {"size_bytes", artifact.size_bytes},
                    {"media_type", artifact.media_type}});
  }
  return list;
}

Json ErrorToJson(const JobError& error) {
  return {{"code", static_cast<int>(error.code)},
          {"reason", error.reason},
          {"message", error.message},
          {"field", error.field}};
}

bool IsArtifactName(std::string_view text) {
  constexpr std::string_view kPrefix = "artifacts/";
  constexpr size_t kDigestLength = 64;
  return text.size() == kPrefix.size() + kDigestLength && text.starts_with(kPrefix) &&
         text.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string_view::npos;
}

void CollectArtifactNames(const Json& value, std::set<std::string>& names) {
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    if (IsArtifactName(text)) names.insert(text);
  }
  if (!value.is_structured()) return;
  for (const Json& item : value) CollectArtifactNames(item, names);
}

}  // namespace

std::string ToJson(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const std::map<std::string, std::string>& labels) {
  return ToJson(Json(labels));
}

std::string ToJson(const JobLimits& limits) {
  Json json = {{"max_errors", limits.max_errors}, {"max_losses", limits.max_losses}};
  PutDuration(json, "deadline_ms", limits.deadline);
  PutDuration(json, "stall_timeout_ms", limits.stall_timeout);
  PutDuration(json, "cancel_grace_ms", limits.cancel_grace);
  return ToJson(json);
}

std::string ToJson(const Progress& progress) {
  return ToJson(Json{{"step", progress.step},
                     {"total", progress.total},
                     {"message", progress.message},
                     {"metrics", progress.metrics}});
}

std::string ToJson(const JobError& error) { return ToJson(ErrorToJson(error)); }

std::string ToJson(const JobCheckpoint& checkpoint) {
  return ToJson(Json{{"artifact", checkpoint.artifact},
                     {"step", checkpoint.step},
                     {"attempt", checkpoint.attempt}});
}

std::string ToJson(const std::vector<JobArtifact>& artifacts) {
  return ToJson(ArtifactsToJson(artifacts));
}

StatusOr<Json> ParseStored(std::string_view text) {
  auto json = base::ParseJson(text, "a job's stored text");
  if (json.ok()) return json;
  return base::MakeError(absl::StatusCode::kDataLoss, "STORE_CORRUPT", "",
                         base::Message(json.status()));
}

StatusOr<std::map<std::string, std::string>> ParseLabels(std::string_view text) {
  return Parse(text,
               [](const Json& json) { return json.get<std::map<std::string, std::string>>(); });
}

StatusOr<JobLimits> ParseLimits(std::string_view text) {
  return Parse(text, [](const Json& json) {
    return JobLimits{.max_errors = base::IntegerFrom<int>(json.at("max_errors")),
                     .max_losses = base::IntegerFrom<int>(json.at("max_losses")),
                     .deadline = GetDuration(json, "deadline_ms"),
                     .stall_timeout = GetDuration(json, "stall_timeout_ms"),
                     .cancel_grace = GetDuration(json, "cancel_grace_ms")};
  });
}

StatusOr<Progress> ParseProgress(std::string_view text) {
  return Parse(text, [](const Json& json) {
    Progress progress{.step = base::IntegerFrom<int64_t>(json.at("step")),
                      .total = base::IntegerFrom<int64_t>(json.at("total")),
                      .message = json.at("message").get<std::string>()};
    for (const auto& [name, value] : json.at("metrics").items()) {
      // JSON has no number for what is not finite.
      progress.metrics[name] =
          value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    }
    return progress;
  });
}

StatusOr<JobError> ParseError(std::string_view text) {
  return Parse(text, [](const Json& json) {
    return JobError{.code = static_cast<absl::StatusCode>(base::IntegerFrom<int>(json.at("code"))),
                    .reason = json.at("reason").get<std::string>(),
                    .message = json.at("message").get<std::string>(),
                    .field = json.at("field").get<std::string>()};
  });
}

StatusOr<JobCheckpoint> ParseCheckpoint(std::string_view text) {
  return Parse(text, [](const Json& json) {
    return JobCheckpoint{.artifact = json.at("artifact").get<std::string>(),
                         .step = base::IntegerFrom<int64_t>(json.at("step")),
                         .attempt = base::IntegerFrom<int>(json.at("attempt"))};
  });
}

StatusOr<std::vector<JobArtifact>> ParseArtifacts(std::string_view text) {
  return Parse(text, [](const Json& json) {
    std::vector<JobArtifact> artifacts;
    for (const Json& item : json) {
      artifacts.push_back({.name = item.at("name").get<std::string>(),
                           .artifact = item.at("artifact").get<std::string>(),
                           .size_bytes = base::IntegerFrom<int64_t>(item.at("size_bytes")),
                           .media_type = item.at("media_type").get<std::string>()});
    }
    return artifacts;
  });
}

std::string OutcomeDigest(const Outcome& outcome) {
  Json json = {{"outcome", api::AttemptOutcomeName(outcome.outcome)},
               {"artifacts", ArtifactsToJson(outcome.artifacts)}};
  if (outcome.error) json["error"] = ErrorToJson(*outcome.error);
  return base::Sha256Hex(ToJson(json));
}

std::vector<std::string> ArtifactNamesIn(const Json& value) {
  std::set<std::string> names;
  CollectArtifactNames(value, names);
  return {names.begin(), names.end()};
}

}  // namespace poise::jobs
