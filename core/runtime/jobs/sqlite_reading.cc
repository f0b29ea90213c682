#include "core/runtime/jobs/sqlite_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

using api::Job;
using api::JobAttempt;
using api::JobEvent;
using api::JobState;

constexpr std::array kOutcomes = {api::AttemptOutcome::kRunning,  api::AttemptOutcome::kSucceeded,
                                  api::AttemptOutcome::kError,    api::AttemptOutcome::kLost,
                                  api::AttemptOutcome::kStalled,  api::AttemptOutcome::kReleased,
                                  api::AttemptOutcome::kCancelled};

// Calls `parse` on a column unless it is NULL.
template <typename Value, typename Parse>
Status ReadOptional(const Query& row, int column, Parse parse, Value& value) {
  if (row.IsNull(column)) return absl::OkStatus();
  POISE_ASSIGN_OR_RETURN(value, parse(row.Text(column)));
  return absl::OkStatus();
}

Status ReadValues(const Query& row, Job& job) {
  POISE_ASSIGN_OR_RETURN(job.state, api::ParseJobState(row.Text(2)));
  POISE_ASSIGN_OR_RETURN(job.spec.parameters, ParseStored(row.Text(4)));
  POISE_ASSIGN_OR_RETURN(job.labels, ParseLabels(row.Text(9)));
  POISE_ASSIGN_OR_RETURN(job.limits, ParseLimits(row.Text(10)));
  POISE_RETURN_IF_ERROR(ReadOptional(row, 14, ParseProgress, job.progress));
  POISE_RETURN_IF_ERROR(ReadOptional(row, 15, ParseError, job.error));
  POISE_RETURN_IF_ERROR(ReadOptional(row, 16, ParseCheckpoint, job.checkpoint));
  return ReadOptional(row, 17, ParseArtifacts, job.artifacts);
}

// What needs no parsing.
Job ReadColumns(const Query& row) {
  return Job{.id = row.Text(0),
             .tenant = row.Text(1),
             .spec = {.kind = row.Text(3)},
             .request_id = row.Text(5),
             .queue = row.Text(6),
             .priority = static_cast<int>(row.Int(7)),
             .seed = std::bit_cast<uint64_t>(row.Int(8)),
             .attempt = static_cast<int>(row.Int(11)),
             .errors = static_cast<int>(row.Int(12)),
             .losses = static_cast<int>(row.Int(13)),
             .event_seq = row.Int(18),
             .create_time = row.Time(19),
             .start_time = row.Time(20),
             .end_time = row.Time(21),
             .expire_time = row.Time(22),
             .next_attempt_time = row.Time(23),
             .retry_of = row.Text(24),
             .trace_id = row.Text(25),
             .cancel_requested_by = row.OptionalText(26).value_or(""),
             .worker = row.Text(27)};
}

StatusOr<std::vector<JobAttempt>> LoadAttempts(Connection& db, int64_t number) {
  std::vector<JobAttempt> attempts;
  Query row = db.Prepare(
      "SELECT a.attempt, a.worker, a.outcome, a.error, a.started_at, a.ended_at, a.cpu_seconds, "
      "a.peak_memory_bytes, a.from_step, coalesce(l.step, a.last_step) FROM attempts a "
      "LEFT JOIN leases l ON l.job = a.job AND l.attempt = a.attempt "
      "WHERE a.job = ? ORDER BY a.attempt",
      number);
  while (row.Step()) {
    JobAttempt attempt{.attempt = static_cast<int>(row.Int(0)),
                       .worker = row.Text(1),
                       .start = row.Time(4),
                       .end = row.Time(5),
                       .usage = {.cpu_seconds = row.Real(6), .peak_memory_bytes = row.Int(7)},
                       .from_step = row.Int(8),
                       .last_step = row.Int(9)};
    const std::string outcome = row.Text(2);
    for (const api::AttemptOutcome each : kOutcomes) {
      if (outcome == api::AttemptOutcomeName(each)) attempt.outcome = each;
    }
    POISE_RETURN_IF_ERROR(ReadOptional(row, 3, ParseError, attempt.error));
    attempts.push_back(std::move(attempt));
  }
  return attempts;
}

StatusOr<JobEvent> ReadEvent(const Query& row) {
  JobEvent event{.seq = row.Int(0),
                 .change = row.Int(1),
                 .time = row.Time(3),
                 .attempt = static_cast<int>(row.Int(4))};
  const std::string type = row.Text(2);
  const std::string value = row.Text(5);
  if (type == "STATE") {
    POISE_ASSIGN_OR_RETURN(event.state, api::ParseJobState(value));
  } else if (type == "PROGRESS") {
    POISE_ASSIGN_OR_RETURN(event.progress, ParseProgress(value));
  } else {
    POISE_ASSIGN_OR_RETURN(event.checkpoint, ParseCheckpoint(value));
  }
  POISE_RETURN_IF_ERROR(ReadOptional(row, 6, ParseError, event.error));
  return event;
}

}  // namespace

StatusOr<Job> ReadJob(const Query& row) {
  Job job = ReadColumns(row);
  POISE_RETURN_IF_ERROR(ReadValues(row, job));
  if (job.state == JobState::kRunning && !row.IsNull(26)) job.state = JobState::kCancelling;
  return job;
}

StatusOr<Job> LoadJob(Connection& db, const std::string& tenant, const std::string& id) {
  Query row = db.Prepare(fmt::format("{}WHERE j.id = ? AND j.tenant = ?", kSelectJob), id, tenant);
  if (!row.Step()) return JobNotFound(id);
  POISE_ASSIGN_OR_RETURN(Job job, ReadJob(row));
  POISE_ASSIGN_OR_RETURN(job.attempts, LoadAttempts(db, row.Int(kNumberColumn)));
  return job;
}

StatusOr<std::vector<JobEvent>> LoadEvents(Connection& db, const std::string& id, int64_t after_seq,
                                           int limit) {
  int64_t number = 0;
  {
    Query row = db.Prepare("SELECT number FROM jobs WHERE id = ?", id);
    if (!row.Step()) return JobNotFound(id);
    number = row.Int(0);
  }
  std::vector<JobEvent> events;
  Query row = db.Prepare(
      "SELECT seq, change, type, time, attempt, value, error FROM events e WHERE job = ? AND "
      "seq > ? AND (type <> 'PROGRESS' OR (SELECT type FROM events n WHERE n.job = e.job AND "
      "n.seq > e.seq ORDER BY n.seq LIMIT 1) IS NOT 'PROGRESS') ORDER BY seq LIMIT ?",
      number, after_seq, std::max(limit, 0));
  while (row.Step()) {
    POISE_ASSIGN_OR_RETURN(JobEvent event, ReadEvent(row));
    events.push_back(std::move(event));
  }
  return events;
}

}  // namespace poise::jobs::sqlite
