#include "core/runtime/jobs/sqlite_lease.h"

#include <fmt/format.h>

#include "core/base/sha256.h"
#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/job_rules.h"
#include "core/runtime/jobs/sqlite_fence.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

constexpr std::string_view kReturning =
    "RETURNING job, attempt, worker, progress, step, progress_pending";

std::vector<EndedLease> ReadEnded(Query& row) {
  std::vector<EndedLease> ended;
  while (row.Step()) {
    ended.push_back({.job = row.Int(0),
                     .attempt = static_cast<int>(row.Int(1)),
                     .worker = row.Text(2),
                     .progress = row.OptionalText(3),
                     .step = row.Int(4),
                     .progress_pending = row.Int(5) != 0});
  }
  return ended;
}

void StoreOutcome(Transaction& t, const EndedLease& lease, const Outcome& outcome,
                  const EndDecision& decision) {
  const auto error =
      decision.attempt_error ? std::optional(ToJson(*decision.attempt_error)) : std::nullopt;
  t.db.Run(
      "UPDATE attempts SET outcome = ?, outcome_digest = ?, led_to = ?, error = ?, ended_at = ?, "
      "cpu_seconds = ?, peak_memory_bytes = ?, last_step = ? WHERE job = ? AND attempt = ?",
      api::AttemptOutcomeName(outcome.outcome), OutcomeDigest(outcome),
      api::JobStateName(decision.state), error, t.now, outcome.usage.cpu_seconds,
      outcome.usage.peak_memory_bytes, lease.step, lease.job, lease.attempt);
  if (lease.progress) {
    t.db.Run("UPDATE jobs SET progress = ? WHERE number = ?", *lease.progress, lease.job);
  }
  if (outcome.outcome == api::AttemptOutcome::kSucceeded) {
    t.db.Run("UPDATE jobs SET artifacts = ? WHERE number = ?", ToJson(outcome.artifacts),
             lease.job);
  }
}

}  // namespace

std::string TokenHash(const std::string& token) { return base::Sha256Hex(token); }

Status LeaseLost(const Fence& fence) {
  return base::MakeError(
      absl::StatusCode::kAborted, "LEASE_LOST", "fence",
      fmt::format("attempt {} of job '{}' is no longer this worker's", fence.attempt, fence.job));
}

std::optional<EndedLease> EndLease(Connection& db, const Fence& fence) {
  Query row =
      db.Prepare(fmt::format("DELETE FROM leases WHERE {} {}", FenceCondition(), kReturning),
                 fence.job, fence.attempt, TokenHash(fence.token));
  std::vector<EndedLease> ended = ReadEnded(row);
  return ended.empty() ? std::nullopt : std::optional(std::move(ended.front()));
}

std::vector<EndedLease> EndLeases(Connection& db, std::string_view condition, int64_t parameter,
                                  int limit) {
  Query row = db.Prepare(
      fmt::format("DELETE FROM leases WHERE job IN (SELECT job FROM leases WHERE {} ORDER BY job "
                  "LIMIT ?) {}",
                  condition, kReturning),
      parameter, limit);
  return ReadEnded(row);
}

std::vector<EndedLease> EndLeasesOfWorker(Connection& db, const std::string& worker) {
  Query row = db.Prepare(fmt::format("DELETE FROM leases WHERE worker = ? {}", kReturning), worker);
  return ReadEnded(row);
}

StatusOr<api::JobState> EndAttempt(Transaction& t, const EndedLease& lease,
                                   const Outcome& outcome) {
  POISE_ASSIGN_OR_RETURN(JobRow job, ReadJobRow(t.db, lease.job));
  if (lease.progress_pending && lease.progress) RecordProgress(t, job, *lease.progress);
  const EndDecision decision = DecideEnd(t.policy, {.job = job.id,
                                                    .outcome = outcome.outcome,
                                                    .error = outcome.error,
                                                    .errors = job.errors,
                                                    .losses = job.losses,
                                                    .limits = job.limits,
                                                    .cancelled_by = job.cancelled_by});
  StoreOutcome(t, lease, outcome, decision);
  job.errors = decision.errors;
  job.losses = decision.losses;
  job.retry_time = decision.retry_delay > absl::ZeroDuration() ? t.now + decision.retry_delay
                                                               : absl::InfiniteFuture();
  ChangeState(t, job, decision.state, decision.error, lease.worker);
  return decision.state;
}

}  // namespace poise::jobs::sqlite
