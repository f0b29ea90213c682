#include "core/runtime/jobs/sqlite_state.h"

#include <fmt/format.h>

#include <utility>

#include "core/runtime/jobs/job_json.h"

namespace poise::jobs::sqlite {
namespace {

using api::JobState;

constexpr std::string_view kColumns =
    "SELECT number, id, tenant, kind, trace_id, state, attempt, errors, losses, event_seq, change, "
    "progress_events, best_step, created_at, state_since, started_at, deadline_at, retry_at, "
    "limits, cancelled_by, checkpoint FROM jobs ";

StatusOr<JobRow> ReadRow(const Query& row) {
  POISE_ASSIGN_OR_RETURN(const JobState state, api::ParseJobState(row.Text(5)));
  POISE_ASSIGN_OR_RETURN(const api::JobLimits limits, ParseLimits(row.Text(18)));
  return JobRow{.number = row.Int(0),
                .id = row.Text(1),
                .tenant = row.Text(2),
                .kind = row.Text(3),
                .trace_id = row.Text(4),
                .state = state,
                .attempt = static_cast<int>(row.Int(6)),
                .errors = static_cast<int>(row.Int(7)),
                .losses = static_cast<int>(row.Int(8)),
                .event_seq = row.Int(9),
                .change = row.Int(10),
                .progress_events = row.Int(11),
                .best_step = row.Int(12),
                .create_time = row.Time(13),
                .state_since = row.Time(14),
                .start_time = row.Time(15),
                .deadline = row.Time(16),
                .retry_time = row.Time(17),
                .limits = limits,
                .cancelled_by = row.OptionalText(19),
                .checkpoint = row.OptionalText(20)};
}

void AddEvent(Transaction& t, const JobRow& job, const char* type, const std::string& value,
              const std::optional<std::string>& error) {
  t.db.Run(
      "INSERT INTO events (job, seq, change, type, time, attempt, value, error) "
      "VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
      job.number, job.event_seq, job.change, type, t.now, job.attempt, value, error);
  t.jobs_with_news.push_back(job.id);
}

// Moves the job from one of the tenant's counters to another.
void Count(Transaction& t, const std::string& tenant, std::optional<JobState> from,
           std::optional<JobState> to) {
  const auto step = [&](JobState state) { return (to == state) - (from == state); };
  t.db.Run(
      "UPDATE tenants SET queued = queued + ?, running = running + ?, succeeded = succeeded + ?, "
      "failed = failed + ?, cancelled = cancelled + ? WHERE name = ?",
      step(JobState::kQueued), step(JobState::kRunning), step(JobState::kSucceeded),
      step(JobState::kFailed), step(JobState::kCancelled), tenant);
}

void Announce(Transaction& t, const JobRow& job, std::optional<JobState> before, JobState to,
              const std::optional<api::JobError>& error, const std::string& worker) {
  t.transitions.push_back({.job = job.id,
                           .tenant = job.tenant,
                           .kind = job.kind,
                           .trace_id = job.trace_id,
                           .worker = worker,
                           .attempt = job.attempt,
                           .from = before,
                           .to = to,
                           .error = error,
                           .in_state = t.now - job.state_since,
                           .next_attempt_time = job.retry_time});
}

// Every second progress event of the job goes, but neither the first nor the newest.
void ThinProgress(Transaction& t, JobRow& job) {
  const int64_t dropped = t.db.Run(
      "DELETE FROM events WHERE job = ?1 AND seq IN (SELECT seq FROM (SELECT seq, row_number() "
      "OVER (ORDER BY seq) AS place FROM events WHERE job = ?1 AND type = 'PROGRESS') "
      "WHERE place % 2 = 0 AND seq < ?2)",
      job.number, job.event_seq);
  job.progress_events -= dropped;
}

}  // namespace

StatusOr<JobRow> ReadJobRow(Connection& db, int64_t number) {
  Query row = db.Prepare(fmt::format("{}WHERE number = ?", kColumns), number);
  if (!row.Step()) {
    return base::MakeError(absl::StatusCode::kDataLoss, "STORE_CORRUPT", "",
                           fmt::format("there is no job number {}", number));
  }
  return ReadRow(row);
}

StatusOr<JobRow> FindJobRow(Connection& db, const std::string& tenant, const std::string& id) {
  Query row = db.Prepare(fmt::format("{}WHERE id = ? AND tenant = ?", kColumns), id, tenant);
  if (!row.Step()) return JobNotFound(id);
  return ReadRow(row);
}

Status JobNotFound(const std::string& id) {
  return base::NotFound("JOB_NOT_FOUND", "name", fmt::format("there is no job '{}'", id));
}

void RecordCreation(Transaction& t, const JobRow& job) {
  Count(t, job.tenant, std::nullopt, job.state);
  AddEvent(t, job, "STATE", api::JobStateName(job.state), std::nullopt);
  Announce(t, job, std::nullopt, job.state, std::nullopt, "");
}

void ChangeState(Transaction& t, JobRow& job, JobState to,
                 const std::optional<api::JobError>& error, const std::string& worker) {
  const JobState before = job.public_state();
  const bool ended = api::IsTerminal(to);
  ++job.event_seq;
  ++job.change;
  const auto error_text = error ? std::optional(ToJson(*error)) : std::nullopt;
  t.db.Run(
      "UPDATE jobs SET state = ?, attempt = ?, errors = ?, losses = ?, error = ?, event_seq = ?, "
      "change = ?, state_since = ?, started_at = ?, ended_at = ?, expires_at = ?, retry_at = ? "
      "WHERE number = ?",
      api::JobStateName(to), job.attempt, job.errors, job.losses, error_text, job.event_seq,
      job.change, t.now, job.start_time, ended ? t.now : absl::InfiniteFuture(),
      ended ? t.now + t.policy.retention : absl::InfiniteFuture(), job.retry_time, job.number);
  Count(t, job.tenant, job.state, to);
  AddEvent(t, job, "STATE", api::JobStateName(to), error_text);
  Announce(t, job, before, to, error, worker);
  job.state = to;
  job.state_since = t.now;
}

void MarkCancelling(Transaction& t, JobRow& job, const std::string& who) {
  ++job.event_seq;
  ++job.change;
  t.db.Run(
      "UPDATE jobs SET cancelled_by = ?, event_seq = ?, change = ?, state_since = ? "
      "WHERE number = ?",
      who, job.event_seq, job.change, t.now, job.number);
  AddEvent(t, job, "STATE", api::JobStateName(JobState::kCancelling), std::nullopt);
  Announce(t, job, job.public_state(), JobState::kCancelling, std::nullopt, "");
  job.cancelled_by = who;
  job.state_since = t.now;
}

void RecordCheckpoint(Transaction& t, JobRow& job, const std::string& checkpoint) {
  ++job.event_seq;
  ++job.change;
  t.db.Run(
      "UPDATE jobs SET checkpoint = ?, best_step = ?, losses = ?, event_seq = ?, change = ? "
      "WHERE number = ?",
      checkpoint, job.best_step, job.losses, job.event_seq, job.change, job.number);
  AddEvent(t, job, "CHECKPOINT", checkpoint, std::nullopt);
}

void RecordProgress(Transaction& t, JobRow& job, const std::string& progress) {
  ++job.event_seq;
  ++job.progress_events;
  AddEvent(t, job, "PROGRESS", progress, std::nullopt);
  if (job.progress_events > t.policy.max_progress_events) ThinProgress(t, job);
  t.db.Run("UPDATE jobs SET event_seq = ?, progress_events = ? WHERE number = ?", job.event_seq,
           job.progress_events, job.number);
}

void RemoveJob(Transaction& t, const JobRow& job) {
  Count(t, job.tenant, job.state, std::nullopt);
  t.db.Run("UPDATE tenants SET deleted = deleted + 1 WHERE name = ?", job.tenant);
  t.db.Run("DELETE FROM jobs WHERE number = ?", job.number);
}

}  // namespace poise::jobs::sqlite
