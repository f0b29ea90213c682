#include <string>
#include <vector>

#include "core/runtime/jobs/job_rules.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_lease.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

Status EndAsLost(Transaction& t, const std::vector<EndedLease>& leases) {
  for (const EndedLease& lease : leases) {
    const Outcome lost{.outcome = api::AttemptOutcome::kLost, .error = WorkerLost(lease.worker)};
    POISE_RETURN_IF_ERROR(EndAttempt(t, lease, lost).status());
  }
  return absl::OkStatus();
}

// When the clock was set back, leases keep their length from now on: a dead worker's would last for
// as long as the clock went back.
void FollowClock(Transaction& t) {
  t.db.Run(
      "UPDATE leases SET expires_at = ?1 + expires_at - heartbeat_at, heartbeat_at = ?1 "
      "WHERE heartbeat_at > ?1",
      t.now);
}

std::vector<int64_t> Numbers(Query& row) {
  std::vector<int64_t> numbers;
  while (row.Step()) numbers.push_back(row.Int(0));
  return numbers;
}

}  // namespace

StatusOr<int64_t> ReapLeases(Transaction& t, int limit) {
  PromoteRetries(t);
  FollowClock(t);
  const auto expired = EndLeases(t.db, "expires_at <= ?", absl::ToUnixMillis(t.now), limit);
  POISE_RETURN_IF_ERROR(EndAsLost(t, expired));
  return static_cast<int64_t>(expired.size());
}

StatusOr<int64_t> ReapDeadlines(Transaction& t, int limit) {
  std::vector<int64_t> queued;
  {
    Query row = t.db.Prepare(
        "SELECT number FROM jobs WHERE deadline_at <= ? AND ended_at IS NULL AND "
        "state = 'QUEUED' ORDER BY deadline_at LIMIT ?",
        t.now, limit);
    queued = Numbers(row);
  }
  for (const int64_t number : queued) {
    POISE_ASSIGN_OR_RETURN(JobRow job, ReadJobRow(t.db, number));
    job.retry_time = absl::InfiniteFuture();
    ChangeState(t, job, api::JobState::kFailed, DeadlinePassed(job.limits), "");
  }
  // The worker knows the deadline and should have stopped: one lease more for its answer.
  const auto overdue = EndLeases(
      t.db, "(SELECT deadline_at FROM jobs WHERE number = leases.job) < ?",
      absl::ToUnixMillis(t.now - t.policy.lease), limit - static_cast<int>(queued.size()));
  for (const EndedLease& lease : overdue) {
    POISE_ASSIGN_OR_RETURN(const JobRow job, ReadJobRow(t.db, lease.job));
    const Outcome late{.outcome = api::AttemptOutcome::kError, .error = DeadlinePassed(job.limits)};
    POISE_RETURN_IF_ERROR(EndAttempt(t, lease, late).status());
  }
  return static_cast<int64_t>(queued.size() + overdue.size());
}

StatusOr<int64_t> ExpireWorkerLeases(Transaction& t, const std::string& worker) {
  const auto leases = EndLeasesOfWorker(t.db, worker);
  POISE_RETURN_IF_ERROR(EndAsLost(t, leases));
  t.db.Run("DELETE FROM workers WHERE id = ?", worker);
  return static_cast<int64_t>(leases.size());
}

StatusOr<int64_t> CollectJobs(Transaction& t, int limit) {
  std::vector<int64_t> expired;
  {
    Query row = t.db.Prepare(
        "SELECT number FROM jobs WHERE expires_at <= ? ORDER BY expires_at LIMIT ?", t.now, limit);
    expired = Numbers(row);
  }
  for (const int64_t number : expired) {
    POISE_ASSIGN_OR_RETURN(const JobRow job, ReadJobRow(t.db, number));
    RemoveJob(t, job);
  }
  return static_cast<int64_t>(expired.size());
}

StatusOr<int64_t> CollectEvents(Transaction& t, int limit) {
  std::vector<int64_t> ended;
  {
    Query row = t.db.Prepare(
        "SELECT number FROM jobs WHERE ended_at <= ? AND old_events = 1 ORDER BY ended_at LIMIT ?",
        t.now - t.policy.event_retention, limit);
    ended = Numbers(row);
  }
  for (const int64_t number : ended) {
    // The last one is terminal: who watches late still gets it.
    t.db.Run(
        "DELETE FROM events WHERE job = ?1 AND seq < (SELECT event_seq FROM jobs WHERE number = "
        "?1)",
        number);
    t.db.Run("UPDATE jobs SET old_events = 0, progress_events = 0 WHERE number = ?", number);
  }
  return static_cast<int64_t>(ended.size());
}

Status CollectWorkers(Transaction& t) {
  t.db.Run("DELETE FROM workers WHERE last_seen <= ? AND id NOT IN (SELECT worker FROM leases)",
           t.now - t.policy.event_retention);
  return absl::OkStatus();
}

}  // namespace poise::jobs::sqlite
