#include <fmt/format.h>

#include <bit>
#include <optional>
#include <string>

#include "core/base/identifier.h"
#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/job_rules.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_reading.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

// The id of the job that the tenant made with this request id.
StatusOr<std::optional<std::string>> FindRequest(Transaction& t, const NewJob& job) {
  if (job.request.request_id.empty()) return std::optional<std::string>();
  Query row =
      t.db.Prepare("SELECT id, content_digest FROM jobs WHERE tenant = ? AND request_id = ?",
                   job.tenant, job.request.request_id);
  if (!row.Step()) return std::optional<std::string>();
  if (row.Text(1) == job.content_digest) return std::optional(row.Text(0));
  return base::InvalidArgument(
      "REQUEST_ID_REUSED", "request_id",
      fmt::format("request_id '{}' made job '{}' with other content: use a new one",
                  job.request.request_id, row.Text(0)));
}

Status CheckRoom(Transaction& t, const std::string& tenant) {
  const JobPolicy& policy = t.policy;
  Query queued = t.db.Prepare("SELECT queued FROM tenants WHERE name = ?", tenant);
  if (queued.Step() && queued.Int(0) >= policy.max_queued_per_tenant) {
    return base::WithRetryDelay(
        base::ResourceExhausted("QUOTA_EXCEEDED", "",
                                fmt::format("tenant '{}' has {} queued jobs, at most {}", tenant,
                                            queued.Int(0), policy.max_queued_per_tenant)),
        policy.quota_retry_delay);
  }
  const int64_t unfinished = t.db.Number("SELECT coalesce(sum(queued + running), 0) FROM tenants");
  if (unfinished < policy.max_unfinished) return absl::OkStatus();
  return base::WithRetryDelay(
      base::MakeError(absl::StatusCode::kUnavailable, "STORE_FULL", "",
                      fmt::format("the job store holds {} unfinished jobs, at most {}", unfinished,
                                  policy.max_unfinished)),
      policy.quota_retry_delay);
}

void InsertSpec(Transaction& t, int64_t number, const NewJob& job) {
  const api::JobSpec& spec = job.request.spec;
  t.db.Run("INSERT INTO specs (job, parameters, labels, seed) VALUES (?, ?, ?, ?)", number,
           ToJson(spec.parameters), ToJson(job.request.labels),
           std::bit_cast<int64_t>(job.request.seed));
  for (const std::string& artifact : ArtifactNamesIn(spec.parameters)) {
    t.db.Run("INSERT INTO inputs (job, artifact) VALUES (?, ?)", number, artifact);
  }
}

JobRow Insert(Transaction& t, const NewJob& job) {
  const api::CreateJob& request = job.request;
  JobRow row{.id = base::TimeOrderedId(t.now),
             .tenant = job.tenant,
             .kind = request.spec.kind,
             .trace_id = job.trace_id,
             .state = api::JobState::kQueued,
             .event_seq = 1,
             .change = 1,
             .create_time = t.now,
             .state_since = t.now,
             .deadline = t.now + request.limits.deadline,
             .limits = request.limits};
  const auto request_id =
      request.request_id.empty() ? std::nullopt : std::optional(request.request_id);
  const auto checkpoint = job.checkpoint ? std::optional(ToJson(*job.checkpoint)) : std::nullopt;
  t.db.Run(
      "INSERT INTO tenants (name, submitted) VALUES (?, 1) "
      "ON CONFLICT DO UPDATE SET submitted = submitted + 1",
      job.tenant);
  {
    Query inserted = t.db.Prepare(
        "INSERT INTO jobs (id, tenant, state, kind, queue, priority, claim_key, request_id, "
        "content_digest, limits, checkpoint, best_step, event_seq, change, created_at, "
        "state_since, deadline_at, retry_of, trace_id) "
        "VALUES (?, ?, 'QUEUED', ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING number",
        row.id, row.tenant, row.kind, request.queue, request.priority,
        ClaimKey(t.policy, t.now, request.priority), request_id, job.content_digest,
        ToJson(request.limits), checkpoint, job.checkpoint ? job.checkpoint->step : int64_t{0},
        row.event_seq, row.change, t.now, t.now, row.deadline, job.retry_of, job.trace_id);
    inserted.Step();
    row.number = inserted.Int(0);
  }
  InsertSpec(t, row.number, job);
  return row;
}

}  // namespace

StatusOr<SubmitOutcome> SubmitJob(Transaction& t, const NewJob& job) {
  POISE_ASSIGN_OR_RETURN(const auto known, FindRequest(t, job));
  if (known) {
    POISE_ASSIGN_OR_RETURN(api::Job existing, LoadJob(t.db, job.tenant, *known));
    return SubmitOutcome{std::move(existing), false};
  }
  POISE_RETURN_IF_ERROR(CheckRoom(t, job.tenant));
  const JobRow row = Insert(t, job);
  RecordCreation(t, row);
  POISE_ASSIGN_OR_RETURN(api::Job created, LoadJob(t.db, job.tenant, row.id));
  return SubmitOutcome{std::move(created), true};
}

}  // namespace poise::jobs::sqlite
