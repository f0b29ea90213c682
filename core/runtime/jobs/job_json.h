#ifndef POISE_CORE_RUNTIME_JOBS_JOB_JSON_H_
#define POISE_CORE_RUNTIME_JOBS_JOB_JSON_H_

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/api/job.h"
#include "core/runtime/jobs/job_store.h"

/// Values as the JSON text that stores keep in one column. Times are whole milliseconds; what is
/// infinite is left out. Bytes that are no UTF-8 become U+FFFD.
/// Errors of every Parse: kDataLoss STORE_CORRUPT.
namespace poise::jobs {

std::string ToJson(const base::Json& value);
std::string ToJson(const std::map<std::string, std::string>& labels);
std::string ToJson(const api::JobLimits& limits);
std::string ToJson(const base::Progress& progress);
std::string ToJson(const api::JobError& error);
std::string ToJson(const api::JobCheckpoint& checkpoint);
std::string ToJson(const std::vector<api::JobArtifact>& artifacts);

StatusOr<base::Json> ParseStored(std::string_view text);
StatusOr<std::map<std::string, std::string>> ParseLabels(std::string_view text);
StatusOr<api::JobLimits> ParseLimits(std::string_view text);
StatusOr<base::Progress> ParseProgress(std::string_view text);
StatusOr<api::JobError> ParseError(std::string_view text);
StatusOr<api::JobCheckpoint> ParseCheckpoint(std::string_view text);
StatusOr<std::vector<api::JobArtifact>> ParseArtifacts(std::string_view text);

/// Tells two outcomes of the same attempt apart.
std::string OutcomeDigest(const Outcome& outcome);

/// Every string "artifacts/<64 hex digits>" in a value, at any depth; each once, sorted.
std::vector<std::string> ArtifactNamesIn(const base::Json& value);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_JOB_JSON_H_
