#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "core/runtime/jobs/sqlite_inspect.h"

namespace poise::jobs::sqlite {
namespace {

using Severity = Finding::Severity;

constexpr int kMaxMessages = 10;  // of one check
constexpr int64_t kLargeLog = int64_t{256} << 20;

/// A query whose rows are faults, each a message.
struct Check {
  const char* name;
  const char* sql;
  const char* good;  ///< said when there is no row
};

constexpr std::array kChecks = {
    Check{"integrity",
          "SELECT integrity_check FROM pragma_integrity_check(10) WHERE integrity_check <> 'ok'",
          "the file's structure is sound"},
    Check{
        "integrity",
        "SELECT 'table ' || \"table\" || ' row ' || coalesce(rowid, '?') || ' names no row of ' || "
        "parent FROM pragma_foreign_key_check",
        "every row belongs to a job"},
    Check{"integrity",
          "SELECT 'job ' || id || ' has lost what it was asked to do' FROM jobs WHERE NOT EXISTS "
          "(SELECT 1 FROM specs WHERE job = number)",
          "every job knows what it was asked to do"},
    Check{"counts",
          "SELECT 'tenant ' || name || ' counts ' || counted || ' ' || state || ' jobs, has ' || "
          "there FROM (SELECT name, column1 AS state, CASE column1 WHEN 'QUEUED' THEN queued "
          "WHEN 'RUNNING' THEN running WHEN 'SUCCEEDED' THEN succeeded WHEN 'FAILED' THEN failed "
          "ELSE cancelled END AS counted, (SELECT count(*) FROM jobs WHERE tenant = name AND "
          "state = column1) AS there FROM tenants, (VALUES ('QUEUED'), ('RUNNING'), "
          "('SUCCEEDED'), ('FAILED'), ('CANCELLED'))) WHERE counted <> there",
          "the tenants' counters are what the jobs say"},
    Check{
        "counts",
        "SELECT 'tenant ' || name || ' submitted ' || submitted || ' jobs, of which ' || known || "
        "' are there or were deleted' FROM (SELECT name, submitted, queued + running + succeeded "
        "+ failed + cancelled + deleted AS known FROM tenants) WHERE submitted <> known",
        "no job is missing"},
    Check{"counts",
          "SELECT 'the store counts ' || value || ' events, has ' || there FROM (SELECT value, "
          "(SELECT count(*) FROM events) AS there FROM settings WHERE name = 'events') "
          "WHERE value <> there",
          "the counter of events is right"},
    Check{"leases",
          "SELECT 'job ' || id || ' is RUNNING without a lease' FROM jobs WHERE state = 'RUNNING' "
          "AND NOT EXISTS (SELECT 1 FROM leases WHERE job = number AND "
          "leases.attempt = jobs.attempt)",
          "every running job has its lease"},
    Check{
        "leases",
        "SELECT 'attempt ' || attempts.attempt || ' of job ' || id || ' runs without a lease' "
        "FROM attempts JOIN jobs ON number = job WHERE outcome = 'RUNNING' AND NOT EXISTS (SELECT "
        "1 FROM leases WHERE leases.job = number AND leases.attempt = attempts.attempt)",
        "every attempt without a lease has ended"},
    Check{"leases",
          "SELECT 'job ' || id || ' is ' || state || ' with a lease' FROM leases JOIN jobs ON "
          "number = job WHERE state <> 'RUNNING'",
          "no other job has one"},
    Check{
        "events",
        "SELECT 'job ' || id || ' ended with ' || terminal || ' terminal events' FROM (SELECT id, "
        "(SELECT count(*) FROM events WHERE job = number AND type = 'STATE' AND value IN "
        "('SUCCEEDED', 'FAILED', 'CANCELLED')) AS terminal FROM jobs WHERE ended_at IS NOT NULL) "
        "WHERE terminal <> 1",
        "every ended job has one terminal event"},
    Check{"events",
          "SELECT 'job ' || id || ' has ' || recorded || ' of ' || change || ' changes in its "
          "events' FROM (SELECT id, change, (SELECT count(*) FROM events WHERE job = number AND "
          "type <> 'PROGRESS') AS recorded FROM jobs WHERE old_events = 1) "
          "WHERE recorded <> change",
          "no event is missing"},
};

void Run(Connection& db, const Check& check, std::vector<Finding>& findings) {
  Query row = db.Prepare(check.sql);
  int count = 0;
  for (; count < kMaxMessages && row.Step(); ++count) {
    findings.push_back({Severity::kFault, check.name, row.Text(0)});
  }
  if (count == 0) findings.push_back({Severity::kOk, check.name, check.good});
}

void CheckWorkers(Connection& db, const JobPolicy& policy, absl::Time now,
                  std::vector<Finding>& findings) {
  Query row = db.Prepare("SELECT id, last_seen FROM workers WHERE last_seen <= ? ORDER BY id",
                         now - 2 * policy.lease);
  const size_t before = findings.size();
  while (row.Step()) {
    findings.push_back({Severity::kWarning, "workers",
                        fmt::format("worker {} was last heard of {} ago", row.Text(0),
                                    absl::FormatDuration(now - row.Time(1)))});
  }
  if (findings.size() == before) {
    findings.push_back({Severity::kOk, "workers", "every known worker was heard of lately"});
  }
}

}  // namespace

StatusOr<std::vector<Finding>> CheckStore(Connection& db, const JobPolicy& policy, absl::Time now) {
  std::vector<Finding> findings;
  for (const Check& check : kChecks) {
    const Status status = Caught([&] { return Run(db, check, findings), absl::OkStatus(); });
    if (status.ok()) continue;
    // So damaged that the check cannot run: that is what was to be found out.
    findings.push_back({Severity::kFault, check.name, base::Message(status)});
  }
  CheckWorkers(db, policy, now, findings);
  return findings;
}

Finding CheckLog(int64_t wal_bytes) {
  const std::string size = fmt::format("the log has {} bytes", wal_bytes);
  if (wal_bytes <= kLargeLog) return {Severity::kOk, "wal", size};
  return {Severity::kWarning, "wal", size + ": something reads for very long"};
}

}  // namespace poise::jobs::sqlite
