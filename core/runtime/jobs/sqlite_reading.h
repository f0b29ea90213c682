#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_READING_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_READING_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"

/// Rows as callers see them; for readers, and for the writer's answers.
namespace poise::jobs::sqlite {

/// A query that ReadJob reads begins with this; `j` is the job's row, `s` its spec.
inline constexpr std::string_view kSelectJob =
    "SELECT j.id, j.tenant, j.state, j.kind, s.parameters, coalesce(j.request_id, ''), j.queue, "
    "j.priority, s.seed, s.labels, j.limits, j.attempt, j.errors, j.losses, "
    "coalesce(l.progress, j.progress), j.error, j.checkpoint, j.artifacts, j.event_seq, "
    "j.created_at, j.started_at, j.ended_at, j.expires_at, j.retry_at, j.retry_of, j.trace_id, "
    "j.cancelled_by, coalesce(l.worker, ''), j.number "
    "FROM jobs j JOIN specs s ON s.job = j.number LEFT JOIN leases l ON l.job = j.number ";
inline constexpr int kNumberColumn = 28;

/// Without attempts.
StatusOr<api::Job> ReadJob(const Query& row);

/// With attempts. Errors: kNotFound JOB_NOT_FOUND.
StatusOr<api::Job> LoadJob(Connection& db, const std::string& tenant, const std::string& id);

/// JobStore::List and JobStore::ReadEvents.
StatusOr<api::JobPage> ListJobs(Connection& db, const ListQuery& query);
StatusOr<std::vector<api::JobEvent>> LoadEvents(Connection& db, const std::string& id,
                                                int64_t after_seq, int limit);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_READING_H_
