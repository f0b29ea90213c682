#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_INSPECT_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_INSPECT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"

/// What operators ask of a store.
namespace poise::jobs::sqlite {

/// All but the sizes of the files.
StatusOr<StoreStats> ReadStats(Connection& db, absl::Time now);
StatusOr<std::vector<WorkerInfo>> ReadWorkers(Connection& db);
StatusOr<std::vector<std::string>> ReadReferencedArtifacts(Connection& db);

/// The checks of JobStore::Diagnose that need the database.
StatusOr<std::vector<Finding>> CheckStore(Connection& db, const JobPolicy& policy, absl::Time now);
/// Of the log beside the file, which a reader that never ends lets grow.
Finding CheckLog(int64_t wal_bytes);

/// A copy of the database as it is now, while it is in use.
Status CopyStore(Connection& db, const std::filesystem::path& path);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_INSPECT_H_
