#include "core/runtime/jobs/sqlite_inspect.h"

#include <SQLiteCpp/Backup.h>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace poise::jobs::sqlite {
namespace {

namespace fs = std::filesystem;
using api::JobState;

// When the tenant's oldest claimable job was made.
absl::Time OldestReady(Connection& db, const std::string& tenant) {
  Query row = db.Prepare(
      "SELECT created_at FROM jobs WHERE tenant = ? AND state = 'QUEUED' AND retry_at IS NULL "
      "ORDER BY number LIMIT 1",
      tenant);
  return row.Step() ? row.Time(0) : absl::InfiniteFuture();
}

Status CannotWrite(const fs::path& path, std::string_view why) {
  return base::FailedPrecondition("CANNOT_WRITE", "path",
                                  fmt::format("cannot write '{}': {}", path.string(), why));
}

// What a rename leaves in a folder's cache only.
void SyncFolder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

StatusOr<StoreStats> ReadStats(Connection& db, absl::Time now) {
  StoreStats stats;
  absl::Time oldest = absl::InfiniteFuture();
  std::vector<std::string> waiting;
  {
    Query row = db.Prepare(
        "SELECT name, queued, running, succeeded, failed, cancelled, submitted, deleted, "
        "coalesce(cancelling, 0) FROM tenants LEFT JOIN (SELECT tenant, count(*) AS cancelling "
        "FROM leases JOIN jobs ON number = job WHERE cancelled_by IS NOT NULL GROUP BY tenant) "
        "ON tenant = name");
    while (row.Step()) {
      const int64_t cancelling = row.Int(8);
      stats.jobs[row.Text(0)] = {
          {JobState::kQueued, row.Int(1)},     {JobState::kRunning, row.Int(2) - cancelling},
          {JobState::kCancelling, cancelling}, {JobState::kSucceeded, row.Int(3)},
          {JobState::kFailed, row.Int(4)},     {JobState::kCancelled, row.Int(5)}};
      stats.submitted += row.Int(6);
      stats.deleted += row.Int(7);
      if (row.Int(1) > 0) waiting.push_back(row.Text(0));
    }
  }
  for (const std::string& tenant : waiting) oldest = std::min(oldest, OldestReady(db, tenant));
  stats.oldest_queued = std::max(now - oldest, absl::ZeroDuration());
  stats.leases = db.Number("SELECT count(*) FROM leases");
  stats.events = db.Number("SELECT value FROM settings WHERE name = 'events'");
  return stats;
}

StatusOr<std::vector<WorkerInfo>> ReadWorkers(Connection& db) {
  std::vector<WorkerInfo> workers;
  Query row = db.Prepare(
      "SELECT id, host, engine, engine_ref, version, slots, last_seen FROM workers ORDER BY id");
  while (row.Step()) {
    workers.push_back({.id = row.Text(0),
                       .host = row.Text(1),
                       .engine = row.Text(2),
                       .engine_ref = row.Text(3),
                       .version = row.Text(4),
                       .slots = static_cast<int>(row.Int(5)),
                       .last_seen = row.Time(6)});
  }
  return workers;
}

StatusOr<std::vector<std::string>> ReadReferencedArtifacts(Connection& db) {
  std::vector<std::string> names;
  Query row = db.Prepare(
      "SELECT artifact FROM inputs "
      "UNION SELECT json_extract(checkpoint, '$.artifact') FROM jobs WHERE checkpoint IS NOT NULL "
      "UNION SELECT json_extract(value, '$.artifact') FROM jobs, json_each(jobs.artifacts) "
      "WHERE artifacts IS NOT NULL");
  while (row.Step()) names.push_back(row.Text(0));
  return names;
}

Status CopyStore(Connection& db, const fs::path& path) {
  std::error_code error;
  if (fs::exists(path, error)) {
    return base::FailedPrecondition("FILE_EXISTS", "path",
                                    fmt::format("'{}' exists already", path.string()));
  }
  fs::path partial = path;
  partial += ".partial";
  fs::remove(partial, error);
  try {
    SQLite::Database copy(partial.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    if (SQLite::Backup(copy, db.database()).executeStep(-1) != SQLITE_DONE) {
      throw SQLite::Exception("the store is locked");
    }
  } catch (const SQLite::Exception& failure) {
    fs::remove(partial, error);
    return CannotWrite(path, failure.what());
  }
  fs::create_hard_link(partial, path, error);  // unlike a rename it never replaces a file
  std::error_code ignored;
  fs::remove(partial, ignored);
  if (error) return CannotWrite(path, error.message());
  SyncFolder(path.parent_path().empty() ? fs::path(".") : path.parent_path());
  return absl::OkStatus();
}

}  // namespace poise::jobs::sqlite
