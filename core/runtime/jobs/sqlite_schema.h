#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_SCHEMA_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_SCHEMA_H_

#include "core/base/status.h"
#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"

namespace poise::jobs::sqlite {

/// Makes the tables of an empty file, or brings an older file up to date; forward only.
/// Errors: kFailedPrecondition NEWER_SCHEMA; kDataLoss STORE_CORRUPT (also: another program's
/// file).
Status Migrate(Connection& db, const JobPolicy& policy);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_SCHEMA_H_
