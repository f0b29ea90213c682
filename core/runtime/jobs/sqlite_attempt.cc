#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_fence.h"
#include "core/runtime/jobs/sqlite_lease.h"
#include "core/runtime/jobs/sqlite_reading.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

// A lease as its heartbeat finds it.
struct LiveLease {
  int64_t job = 0;
  std::string worker;
  std::optional<std::string> progress;
  bool pending = false;
  absl::Time last_event;  ///< InfiniteFuture before the first
  bool cancelled = false;
};

StatusOr<LiveLease> FindLease(Transaction& t, const Fence& fence) {
  Query row = t.db.Prepare(
      fmt::format("SELECT job, worker, progress, progress_pending, progress_event_at, (SELECT "
                  "cancelled_by IS NOT NULL FROM jobs WHERE number = job) FROM leases WHERE {}",
                  FenceCondition()),
      fence.job, fence.attempt, TokenHash(fence.token));
  if (!row.Step()) return LeaseLost(fence);
  return LiveLease{.job = row.Int(0),
                   .worker = row.Text(1),
                   .progress = row.OptionalText(2),
                   .pending = row.Int(3) != 0,
                   .last_event = row.Time(4),
                   .cancelled = row.Int(5) != 0};
}

Status StoreProgress(Transaction& t, LiveLease& lease,
                     const std::optional<base::Progress>& progress) {
  const auto text = progress ? std::optional(ToJson(*progress)) : std::nullopt;
  if (text && text != lease.progress) {
    lease.progress = text;
    lease.pending = true;
    t.db.Run("UPDATE leases SET progress = ?, step = ?, progress_pending = 1 WHERE job = ?", *text,
             progress->step, lease.job);
  }
  const bool first = lease.last_event == absl::InfiniteFuture();
  if (!lease.pending || (!first && t.now < lease.last_event + t.policy.progress_interval)) {
    return absl::OkStatus();
  }
  POISE_ASSIGN_OR_RETURN(JobRow job, ReadJobRow(t.db, lease.job));
  RecordProgress(t, job, *lease.progress);
  t.db.Run("UPDATE leases SET progress_pending = 0, progress_event_at = ? WHERE job = ?", t.now,
           lease.job);
  return absl::OkStatus();
}

// What an earlier call with the same fence and outcome led to.
StatusOr<api::JobState> EarlierFinish(Transaction& t, const Fence& fence, const Outcome& outcome) {
  Query row = t.db.Prepare(
      "SELECT led_to FROM attempts WHERE job = (SELECT number FROM jobs WHERE id = ?) AND "
      "attempt = ? AND token_hash = ? AND outcome_digest = ?",
      fence.job, fence.attempt, TokenHash(fence.token), OutcomeDigest(outcome));
  if (!row.Step()) return LeaseLost(fence);
  return api::ParseJobState(row.Text(0));
}

StatusOr<api::JobState> EndOwnAttempt(Transaction& t, const Fence& fence, const Outcome& outcome) {
  const auto lease = EndLease(t.db, fence);
  if (!lease) return EarlierFinish(t, fence, outcome);
  return EndAttempt(t, *lease, outcome);
}

bool IsEnd(api::AttemptOutcome outcome) {
  return outcome != api::AttemptOutcome::kRunning && outcome != api::AttemptOutcome::kReleased;
}

}  // namespace

StatusOr<HeartbeatReply> ExtendLease(Transaction& t, const Fence& fence,
                                     const std::optional<base::Progress>& progress) {
  POISE_ASSIGN_OR_RETURN(LiveLease lease, FindLease(t, fence));
  t.db.Run("UPDATE leases SET expires_at = ?, heartbeat_at = ? WHERE job = ?",
           t.now + t.policy.lease, t.now, lease.job);
  POISE_RETURN_IF_ERROR(StoreProgress(t, lease, progress));
  SeeWorker(t, lease.worker);
  return HeartbeatReply{lease.cancelled ? Directive::kCancel : Directive::kContinue,
                        t.policy.lease};
}

StatusOr<api::Job> LeasedJob(Transaction& t, const Fence& fence) {
  POISE_ASSIGN_OR_RETURN(const LiveLease lease, FindLease(t, fence));
  POISE_ASSIGN_OR_RETURN(const JobRow job, ReadJobRow(t.db, lease.job));
  return LoadJob(t.db, job.tenant, job.id);
}

Status SaveCheckpoint(Transaction& t, const Fence& fence, const std::string& artifact,
                      int64_t step) {
  int64_t number = 0;
  {
    Query row = t.db.Prepare(
        fmt::format("UPDATE leases SET heartbeat_at = ?4, step = max(step, ?5) WHERE {} "
                    "RETURNING job",
                    FenceCondition()),
        fence.job, fence.attempt, TokenHash(fence.token), t.now, step);
    if (!row.Step()) return LeaseLost(fence);
    number = row.Int(0);
  }
  POISE_ASSIGN_OR_RETURN(JobRow job, ReadJobRow(t.db, number));
  if (job.checkpoint) {
    POISE_ASSIGN_OR_RETURN(const api::JobCheckpoint last, ParseCheckpoint(*job.checkpoint));
    // Said before, or overtaken by a later one of the same attempt.
    if (last.attempt == job.attempt && step <= last.step) return absl::OkStatus();
  }
  if (step > job.best_step) {
    job.best_step = step;
    job.losses = 0;
  }
  RecordCheckpoint(t, job, ToJson(api::JobCheckpoint{artifact, step, job.attempt}));
  return absl::OkStatus();
}

StatusOr<api::JobState> FinishAttempt(Transaction& t, const Fence& fence, const Outcome& outcome) {
  if (!IsEnd(outcome.outcome)) {
    return base::InvalidArgument(
        "BAD_OUTCOME", "outcome",
        fmt::format("an attempt cannot finish as {}", api::AttemptOutcomeName(outcome.outcome)));
  }
  return EndOwnAttempt(t, fence, outcome);
}

Status ReleaseAttempt(Transaction& t, const Fence& fence, const api::JobUsage& usage) {
  const Outcome released{.outcome = api::AttemptOutcome::kReleased, .usage = usage};
  return EndOwnAttempt(t, fence, released).status();
}

}  // namespace poise::jobs::sqlite
