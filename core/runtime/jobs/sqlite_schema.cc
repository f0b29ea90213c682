#include "core/runtime/jobs/sqlite_schema.h"

#include <fmt/format.h>

#include <array>

#include "core/runtime/jobs/job_rules.h"

namespace poise::jobs::sqlite {
namespace {

// Times are milliseconds since 1970; a time that has not come is NULL. States are the names of
// api::JobState without CANCELLING, which is RUNNING with a wish to cancel.
//
// `jobs` holds what changes, `specs` what never does; `leases` is narrow because heartbeats write
// it. The two indexes of claimable jobs are in the order in which Claim takes them, so that it
// reads one row of each queue and kind, however many jobs wait. A job that waits for its next
// attempt (retry_at) is in neither of them. Events are counted as they come and go: there may be
// millions, and everybody asks how many.
constexpr char kVersion1[] = R"(
CREATE TABLE tenants (
  name TEXT PRIMARY KEY,
  queued INTEGER NOT NULL DEFAULT 0 CHECK (queued >= 0),
  running INTEGER NOT NULL DEFAULT 0 CHECK (running >= 0),
  succeeded INTEGER NOT NULL DEFAULT 0 CHECK (succeeded >= 0),
  failed INTEGER NOT NULL DEFAULT 0 CHECK (failed >= 0),
  cancelled INTEGER NOT NULL DEFAULT 0 CHECK (cancelled >= 0),
  submitted INTEGER NOT NULL DEFAULT 0,
  deleted INTEGER NOT NULL DEFAULT 0,
  turn REAL NOT NULL DEFAULT 0
) STRICT, WITHOUT ROWID;

CREATE TABLE jobs (
  number INTEGER PRIMARY KEY,
  id TEXT NOT NULL UNIQUE,
  tenant TEXT NOT NULL REFERENCES tenants (name),
  state TEXT NOT NULL CHECK (state IN ('QUEUED', 'RUNNING', 'SUCCEEDED', 'FAILED', 'CANCELLED')),
  kind TEXT NOT NULL,
  queue TEXT NOT NULL,
  priority INTEGER NOT NULL,
  claim_key INTEGER NOT NULL,
  request_id TEXT,
  content_digest TEXT NOT NULL,
  limits TEXT NOT NULL,
  attempt INTEGER NOT NULL DEFAULT 0,
  errors INTEGER NOT NULL DEFAULT 0,
  losses INTEGER NOT NULL DEFAULT 0,
  progress TEXT,
  error TEXT,
  checkpoint TEXT,
  best_step INTEGER NOT NULL DEFAULT 0,
  artifacts TEXT,
  event_seq INTEGER NOT NULL DEFAULT 0,
  change INTEGER NOT NULL DEFAULT 0,
  progress_events INTEGER NOT NULL DEFAULT 0,
  created_at INTEGER NOT NULL,
  state_since INTEGER NOT NULL,
  started_at INTEGER,
  ended_at INTEGER,
  expires_at INTEGER,
  retry_at INTEGER,
  deadline_at INTEGER,
  cancelled_by TEXT,
  retry_of TEXT NOT NULL,
  trace_id TEXT NOT NULL,
  old_events INTEGER NOT NULL DEFAULT 1,
  CHECK ((ended_at IS NOT NULL) = (state IN ('SUCCEEDED', 'FAILED', 'CANCELLED'))),
  CHECK (retry_at IS NULL OR state = 'QUEUED')
) STRICT;
CREATE UNIQUE INDEX jobs_request ON jobs (tenant, request_id) WHERE request_id IS NOT NULL;
CREATE INDEX jobs_of_tenant ON jobs (tenant);
CREATE INDEX jobs_by_state ON jobs (tenant, state);
CREATE INDEX jobs_ready_by_kind ON jobs (tenant, kind, claim_key)
  WHERE state = 'QUEUED' AND retry_at IS NULL;
CREATE INDEX jobs_ready_by_queue ON jobs (tenant, queue, kind, claim_key)
  WHERE state = 'QUEUED' AND retry_at IS NULL;
CREATE INDEX jobs_retry ON jobs (retry_at) WHERE retry_at IS NOT NULL;
CREATE INDEX jobs_deadline ON jobs (deadline_at) WHERE deadline_at IS NOT NULL AND ended_at IS NULL;
CREATE INDEX jobs_expiry ON jobs (expires_at) WHERE expires_at IS NOT NULL;
CREATE INDEX jobs_old_events ON jobs (ended_at) WHERE ended_at IS NOT NULL AND old_events = 1;

CREATE TABLE specs (
  job INTEGER PRIMARY KEY REFERENCES jobs (number) ON DELETE CASCADE,
  parameters TEXT NOT NULL,
  labels TEXT NOT NULL,
  seed INTEGER NOT NULL
) STRICT;

CREATE TABLE inputs (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
  artifact TEXT NOT NULL,
  PRIMARY KEY (job, artifact)
) STRICT, WITHOUT ROWID;

CREATE TABLE leases (
  job INTEGER PRIMARY KEY REFERENCES jobs (number),
  attempt INTEGER NOT NULL,
  token_hash TEXT NOT NULL,
  worker TEXT NOT NULL,
  expires_at INTEGER NOT NULL,
  heartbeat_at INTEGER NOT NULL,
  progress TEXT,
  step INTEGER NOT NULL DEFAULT 0,
  progress_pending INTEGER NOT NULL DEFAULT 0,
  progress_event_at INTEGER,
  repeats INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX leases_by_token ON leases (worker, token_hash);

CREATE TABLE attempts (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
  attempt INTEGER NOT NULL,
  worker TEXT NOT NULL,
  token_hash TEXT NOT NULL,
  outcome TEXT NOT NULL,
  outcome_digest TEXT,
  led_to TEXT,
  error TEXT,
  started_at INTEGER NOT NULL,
  ended_at INTEGER,
  cpu_seconds REAL NOT NULL DEFAULT 0,
  peak_memory_bytes INTEGER NOT NULL DEFAULT 0,
  from_step INTEGER NOT NULL,
  last_step INTEGER NOT NULL DEFAULT 0,
  PRIMARY KEY (job, attempt)
) STRICT, WITHOUT ROWID;

CREATE TABLE events (
  job INTEGER NOT NULL REFERENCES jobs (number) ON DELETE CASCADE,
  seq INTEGER NOT NULL,
  change INTEGER NOT NULL,
  type TEXT NOT NULL CHECK (type IN ('STATE', 'PROGRESS', 'CHECKPOINT')),
  time INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  value TEXT NOT NULL,
  error TEXT,
  PRIMARY KEY (job, seq)
) STRICT, WITHOUT ROWID;
INSERT INTO settings VALUES ('events', 0);
CREATE TRIGGER event_added AFTER INSERT ON events BEGIN
  UPDATE settings SET value = value + 1 WHERE name = 'events';
END;
CREATE TRIGGER event_removed AFTER DELETE ON events BEGIN
  UPDATE settings SET value = value - 1 WHERE name = 'events';
END;

CREATE TABLE workers (
  id TEXT PRIMARY KEY,
  host TEXT NOT NULL,
  engine TEXT NOT NULL,
  engine_ref TEXT NOT NULL,
  version TEXT NOT NULL,
  slots INTEGER NOT NULL,
  last_seen INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
)";

// Step n brings a file from version n to n + 1.
constexpr std::array kSteps = {kVersion1};

constexpr char kMakeSettings[] = R"(
CREATE TABLE settings (name TEXT PRIMARY KEY, value INTEGER NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO settings VALUES ('schema_version', 0), ('age_step_ms', 0);
)";

int64_t Setting(Connection& db, const char* name) {
  Query row = db.Prepare("SELECT value FROM settings WHERE name = ?", name);
  return row.Step() ? row.Int(0) : 0;
}

void SetSetting(Connection& db, const char* name, int64_t value) {
  db.Run("UPDATE settings SET value = ? WHERE name = ?", value, name);
}

// Waiting jobs are sorted by keys that depend on the age step: made anew when it has changed.
void SortWaitingJobs(Connection& db, const JobPolicy& policy) {
  const int64_t lift = ClaimKey(policy, absl::UnixEpoch(), -1);
  if (Setting(db, "age_step_ms") == lift) return;
  db.Run("UPDATE jobs SET claim_key = created_at - priority * ? WHERE ended_at IS NULL", lift);
  SetSetting(db, "age_step_ms", lift);
}

Status MigrateInTransaction(Connection& db, const JobPolicy& policy) {
  const bool empty = db.Number("SELECT count(*) FROM sqlite_schema") == 0;
  if (empty) {
    db.Script(kMakeSettings);
  } else if (db.Number("SELECT count(*) FROM sqlite_schema WHERE name = 'settings'") == 0) {
    return base::MakeError(absl::StatusCode::kDataLoss, "STORE_CORRUPT", "store",
                           "the file is a database, but no job store");
  }
  int64_t version = Setting(db, "schema_version");
  const auto newest = static_cast<int64_t>(kSteps.size());
  if (version > newest) {
    return base::FailedPrecondition(
        "NEWER_SCHEMA", "store",
        fmt::format("the job store has schema version {}, this program knows up to {}: use the "
                    "program that wrote it, or a newer one",
                    version, newest));
  }
  for (; version < newest; ++version) db.Script(kSteps[version]);
  SetSetting(db, "schema_version", version);
  SortWaitingJobs(db, policy);
  return absl::OkStatus();
}

}  // namespace

Status Migrate(Connection& db, const JobPolicy& policy) {
  db.Script("BEGIN IMMEDIATE");
  const Status status = Caught([&] { return MigrateInTransaction(db, policy); });
  db.Script(status.ok() ? "COMMIT" : "ROLLBACK");
  return status;
}

}  // namespace poise::jobs::sqlite
