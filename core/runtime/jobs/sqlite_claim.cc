#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <compare>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/job_rules.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_lease.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {
namespace {

constexpr int kMaxPromoted = 256;    // per call, so that a claim stays short
constexpr int kMaxOverdue = 256;     // the same
constexpr int kMaxRepeats = 10;      // of a claim whose answer was lost
constexpr double kMinWeight = 1e-6;  // a tenant of weight 0 comes last

// A job at the head of a tenant's queue; the smallest is next.
struct Head {
  int64_t claim_key = 0;
  int64_t number = 0;
  auto operator<=>(const Head&) const = default;
};

// How much a tenant has already; the smallest is next. Of those with equally many running jobs for
// their weight, few slots may keep all at 0, the next is the one with the earliest turn: each claim
// moves the tenant's turn on by 1 / weight, and a tenant that had nothing to do saves nothing up.
struct Share {
  double running_per_weight = 0;
  double turn = 0;
  auto operator<=>(const Share&) const = default;
};

struct Candidate {
  Share share;
  std::string tenant;
};

struct Choice {
  Share share;
  Head head;
};

bool IsKnown(Transaction& t, const std::string& worker) {
  Query row = t.db.Prepare("SELECT 1 FROM workers WHERE id = ?", worker);
  return row.Step();
}

// The tenants that may have a job more, those first that have least for their weight.
std::vector<Candidate> TenantsByShare(Transaction& t) {
  std::vector<Candidate> candidates;
  Query row = t.db.Prepare(
      "SELECT name, running, turn, (SELECT max(turn) FROM tenants) FROM tenants "
      "WHERE queued > 0 AND running < ?",
      t.policy.max_running_per_tenant);
  while (row.Step()) {
    const auto entry = t.policy.tenant_weights.find(row.Text(0));
    const double weight =
        entry == t.policy.tenant_weights.end() ? 1.0 : std::max(entry->second, kMinWeight);
    candidates.push_back({{.running_per_weight = static_cast<double>(row.Int(1)) / weight,
                           .turn = std::max(row.Real(2) + 1 / weight, row.Real(3))},
                          row.Text(0)});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.share < b.share; });
  return candidates;
}

// The kinds of which a tenant has claimable jobs, one step in the index for each.
std::vector<std::string> ReadyKinds(Transaction& t, const std::string& tenant) {
  std::vector<std::string> kinds;
  for (std::string last;;) {
    Query row = t.db.Prepare(
        "SELECT kind FROM jobs INDEXED BY jobs_ready_by_kind WHERE tenant = ? AND kind > ? AND "
        "state = 'QUEUED' AND retry_at IS NULL ORDER BY kind LIMIT 1",
        tenant, last);
    if (!row.Step()) return kinds;
    last = row.Text(0);
    kinds.push_back(last);
  }
}

void TakeBetter(Query& row, std::optional<Head>& best) {
  if (!row.Step()) return;
  const Head head{row.Int(0), row.Int(1)};
  if (!best || head < *best) best = head;
}

// The tenant's next job that this worker may run: the best of the heads of each queue and kind.
std::optional<Head> NextOf(Transaction& t, const std::string& tenant, const ClaimQuery& query) {
  std::optional<Head> best;
  const auto kinds = query.kinds.empty() ? ReadyKinds(t, tenant) : query.kinds;
  for (const std::string& kind : kinds) {
    if (query.queues.empty()) {
      Query row = t.db.Prepare(
          "SELECT claim_key, number FROM jobs INDEXED BY jobs_ready_by_kind WHERE tenant = ? AND "
          "kind = ? AND state = 'QUEUED' AND retry_at IS NULL ORDER BY claim_key, number LIMIT 1",
          tenant, kind);
      TakeBetter(row, best);
    }
    for (const std::string& queue : query.queues) {
      Query row = t.db.Prepare(
          "SELECT claim_key, number FROM jobs INDEXED BY jobs_ready_by_queue WHERE tenant = ? AND "
          "queue = ? AND kind = ? AND state = 'QUEUED' AND retry_at IS NULL "
          "ORDER BY claim_key, number LIMIT 1",
          tenant, queue, kind);
      TakeBetter(row, best);
    }
  }
  return best;
}

// The next job of the tenant with the smallest share; of several with the same, the best head.
std::optional<Choice> NextJob(Transaction& t, const ClaimQuery& query) {
  std::optional<Choice> best;
  for (const Candidate& candidate : TenantsByShare(t)) {
    if (best && candidate.share > best->share) break;
    const auto head = NextOf(t, candidate.tenant, query);
    if (head && (!best || *head < best->head)) best = Choice{candidate.share, *head};
  }
  return best;
}

StatusOr<Lease> ReadLease(Transaction& t, const JobRow& job, const ClaimQuery& query) {
  Query row = t.db.Prepare("SELECT parameters, seed FROM specs WHERE job = ?", job.number);
  row.Step();
  Lease lease{.fence = {job.id, job.attempt, query.token},
              .expires_in = t.policy.lease,
              .spec = {.kind = job.kind},
              .seed = std::bit_cast<uint64_t>(row.Int(1)),
              .limits = job.limits,
              .trace_id = job.trace_id,
              .deadline_in = job.deadline - t.now};
  POISE_ASSIGN_OR_RETURN(lease.spec.parameters, ParseStored(row.Text(0)));
  if (job.checkpoint) {
    POISE_ASSIGN_OR_RETURN(lease.checkpoint, ParseCheckpoint(*job.checkpoint));
  }
  return lease;
}

StatusOr<Lease> StartAttempt(Transaction& t, JobRow job, const ClaimQuery& query) {
  ++job.attempt;
  job.start_time = std::min(job.start_time, t.now);
  const std::string token_hash = TokenHash(query.token);
  POISE_ASSIGN_OR_RETURN(Lease lease, ReadLease(t, job, query));
  const int64_t from_step = lease.checkpoint ? lease.checkpoint->step : 0;
  t.db.Run(
      "INSERT INTO leases (job, attempt, token_hash, worker, expires_at, heartbeat_at, step) "
      "VALUES (?, ?, ?, ?, ?, ?, ?)",
      job.number, job.attempt, token_hash, query.worker, t.now + t.policy.lease, t.now, from_step);
  t.db.Run(
      "INSERT INTO attempts (job, attempt, worker, token_hash, outcome, started_at, from_step, "
      "last_step) VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
      job.number, job.attempt, query.worker, token_hash,
      api::AttemptOutcomeName(api::AttemptOutcome::kRunning), t.now, from_step, from_step);
  ChangeState(t, job, api::JobState::kRunning, std::nullopt, query.worker);
  return lease;
}

// The lease that an earlier call with this token gave, taken further: its answer was lost. A worker
// that asks again and again, and never hears, loses it in the end.
StatusOr<std::optional<Lease>> RepeatedClaim(Transaction& t, const ClaimQuery& query) {
  int64_t number = 0;
  absl::Time expiry;
  {
    Query row = t.db.Prepare(
        "UPDATE leases SET repeats = repeats + 1, heartbeat_at = ?, "
        "expires_at = CASE WHEN repeats < ? THEN ? ELSE expires_at END "
        "WHERE worker = ? AND token_hash = ? RETURNING job, expires_at",
        t.now, kMaxRepeats, t.now + t.policy.lease, query.worker, TokenHash(query.token));
    if (!row.Step()) return std::optional<Lease>();
    number = row.Int(0);
    expiry = row.Time(1);
  }
  POISE_ASSIGN_OR_RETURN(const JobRow job, ReadJobRow(t.db, number));
  POISE_ASSIGN_OR_RETURN(Lease lease, ReadLease(t, job, query));
  lease.expires_in = std::max(expiry - t.now, absl::ZeroDuration());
  return std::optional(std::move(lease));
}

}  // namespace

void PromoteRetries(Transaction& t) {
  t.db.Run(
      "UPDATE jobs SET retry_at = NULL WHERE number IN (SELECT number FROM jobs WHERE "
      "retry_at <= ? ORDER BY retry_at LIMIT ?)",
      t.now, kMaxPromoted);
}

void SeeWorker(Transaction& t, const std::string& worker) {
  t.db.Run("UPDATE workers SET last_seen = ? WHERE id = ? AND last_seen <= ?", t.now, worker,
           t.now - t.policy.heartbeat_interval / 2);
}

Status UpsertWorker(Transaction& t, const WorkerInfo& worker) {
  t.db.Run(
      "INSERT INTO workers (id, host, engine, engine_ref, version, slots, last_seen) "
      "VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO UPDATE SET host = excluded.host, "
      "engine = excluded.engine, engine_ref = excluded.engine_ref, version = excluded.version, "
      "slots = excluded.slots, last_seen = excluded.last_seen",
      worker.id, worker.host, worker.engine, worker.engine_ref, worker.version, worker.slots,
      t.now);
  return absl::OkStatus();
}

StatusOr<std::optional<Lease>> ClaimJob(Transaction& t, const ClaimQuery& query) {
  if (!IsKnown(t, query.worker)) {
    return base::FailedPrecondition(
        "UNKNOWN_WORKER", "worker",
        fmt::format("worker '{}' is not registered: register first", query.worker));
  }
  SeeWorker(t, query.worker);
  POISE_ASSIGN_OR_RETURN(auto repeated, RepeatedClaim(t, query));
  if (repeated) return repeated;
  PromoteRetries(t);
  for (int overdue = 0; overdue <= kMaxOverdue; ++overdue) {
    const auto choice = NextJob(t, query);
    if (!choice) break;
    POISE_ASSIGN_OR_RETURN(JobRow job, ReadJobRow(t.db, choice->head.number));
    if (job.deadline <= t.now) {
      ChangeState(t, job, api::JobState::kFailed, DeadlinePassed(job.limits), "");
      continue;
    }
    t.db.Run("UPDATE tenants SET turn = ? WHERE name = ?", choice->share.turn, job.tenant);
    POISE_ASSIGN_OR_RETURN(Lease lease, StartAttempt(t, std::move(job), query));
    return std::optional(std::move(lease));
  }
  return std::optional<Lease>();
}

}  // namespace poise::jobs::sqlite
