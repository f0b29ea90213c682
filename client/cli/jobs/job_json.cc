#include "client/cli/jobs/job_json.h"

#include "absl/time/time.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

using base::Json;

Json TimeJson(absl::Time time) {
  if (time == absl::InfiniteFuture() || time == absl::InfinitePast()) return nullptr;
  return std::string(absl::FormatTime("%Y-%m-%dT%H:%M:%E3SZ", time, absl::UTCTimeZone()));
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json ErrorJson(const std::optional<api::JobError>& error) {
  if (!error) return nullptr;
  return {{"code", absl::StatusCodeToString(error->code)},
          {"reason", error->reason},
          {"message", error->message},
          {"field", error->field}};
}

// Always with the measures that every kind of job may have, and with those of its own.
Json ProgressJson(const base::Progress& progress) {
  Json json = {{"step", progress.step},
               {"total", progress.total},
               {"samples", nullptr},
               {"reward", nullptr},
               {"eta_s", nullptr}};
  for (const auto& [name, value] : progress.metrics) json[name] = value;
  json["message"] = progress.message;
  return json;
}

Json CheckpointJson(const std::optional<api::JobCheckpoint>& checkpoint) {
  if (!checkpoint) return nullptr;
  return {{"artifact", checkpoint->artifact},
          {"step", checkpoint->step},
          {"attempt", checkpoint->attempt}};
}

Json AttemptJson(const api::JobAttempt& attempt) {
  return {{"attempt", attempt.attempt},
          {"worker", attempt.worker},
          {"outcome", api::AttemptOutcomeName(attempt.outcome)},
          {"error", ErrorJson(attempt.error)},
          {"start_time", TimeJson(attempt.start)},
          {"end_time", TimeJson(attempt.end)},
          {"cpu_seconds", attempt.usage.cpu_seconds},
          {"peak_memory_bytes", attempt.usage.peak_memory_bytes},
          {"from_step", attempt.from_step},
          {"last_step", attempt.last_step}};
}

Json ArtifactsJson(const std::vector<api::JobArtifact>& artifacts) {
  Json json = Json::array();
  for (const api::JobArtifact& artifact : artifacts) {
    json.push_back({{"name", artifact.name},
                    {"artifact", artifact.artifact},
                    {"size_bytes", artifact.size_bytes},
                    {"media_type", artifact.media_type}});
  }
  return json;
}

}  // namespace

base::Json JobJson(const api::Job& job) {
  Json attempts = Json::array();
  for (const api::JobAttempt& attempt : job.attempts) attempts.push_back(AttemptJson(attempt));
  Json labels = Json::object();
  for (const auto& [key, value] : job.labels) labels[key] = value;
  return {{"name", convert::JobName(job.id)},
          {"kind", job.spec.kind},
          {"state", api::JobStateName(job.state)},
          {"request_id", job.request_id},
          {"attempt", job.attempt},
          {"losses", job.losses},
          {"errors", job.errors},
          {"progress", ProgressJson(job.progress)},
          {"attempts", std::move(attempts)},
          {"error", ErrorJson(job.error)},
          {"parameters", job.spec.parameters},
          {"queue", job.queue},
          {"priority", job.priority},
          {"seed", job.seed},
          {"labels", std::move(labels)},
          {"checkpoint", CheckpointJson(job.checkpoint)},
          {"artifacts", ArtifactsJson(job.artifacts)},
          {"worker", TextOrNull(job.worker)},
          {"create_time", TimeJson(job.create_time)},
          {"start_time", TimeJson(job.start_time)},
          {"end_time", TimeJson(job.end_time)},
          {"next_attempt_time", TimeJson(job.next_attempt_time)},
          {"expire_time", TimeJson(job.expire_time)},
          {"retry_of", job.retry_of.empty() ? Json(nullptr) : Json(convert::JobName(job.retry_of))},
          {"cancel_requested_by", TextOrNull(job.cancel_requested_by)},
          {"trace_id", job.trace_id}};
}

base::Json EventJson(const std::string& id, const api::JobEvent& event) {
  Json json = {{"name", convert::JobName(id)},
               {"seq", event.seq},
               {"time", TimeJson(event.time)},
               {"attempt", event.attempt}};
  if (event.state) {
    json["state"] = api::JobStateName(*event.state);
    json["error"] = ErrorJson(event.error);
  }
  if (event.progress) json["progress"] = ProgressJson(*event.progress);
  if (event.checkpoint) json["checkpoint"] = CheckpointJson(event.checkpoint);
  return json;
}

}  // namespace poise::cli
