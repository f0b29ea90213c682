#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_JOB_STORE_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_JOB_STORE_H_

#include <filesystem>
#include <functional>
#include <memory>

#include "absl/time/clock.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::jobs {

struct SqliteStoreConfig {
  std::filesystem::path path;  ///< the database file, made when absent
  JobPolicy policy = {};
  int readers = 4;                                 ///< [> 0] connections that only read
  std::function<absl::Time()> clock = &absl::Now;  ///< tests pass their own
};

/// Jobs in one SQLite file, owned by one process.
/// Errors: kFailedPrecondition STORE_IN_USE (another process has it), STORE_ON_NETWORK (NFS,
/// Lustre, SMB, 9p: SQLite's locks do not hold there), NEWER_SCHEMA, BAD_DATA_DIR; kDataLoss
/// STORE_CORRUPT.
StatusOr<std::unique_ptr<JobStore>> OpenSqliteJobStore(SqliteStoreConfig config);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_JOB_STORE_H_
