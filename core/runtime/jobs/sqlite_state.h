#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_STATE_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_STATE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "core/runtime/jobs/job_store.h"
#include "core/runtime/jobs/sqlite_connection.h"
#include "core/runtime/jobs/sqlite_writer.h"

/// The one place where jobs change state and events are recorded.
namespace poise::jobs::sqlite {

/// What a job's row holds of its life so far.
struct JobRow {
  int64_t number = 0;
  std::string id, tenant, kind, trace_id;
  api::JobState state{};  ///< never kCancelling
  int attempt = 0;
  int errors = 0;
  int losses = 0;
  int64_t event_seq = 0;
  int64_t change = 0;
  int64_t progress_events = 0;
  int64_t best_step = 0;
  absl::Time create_time, state_since;
  absl::Time start_time = absl::InfiniteFuture();
  absl::Time deadline = absl::InfiniteFuture();
  absl::Time retry_time = absl::InfiniteFuture();
  api::JobLimits limits;
  std::optional<std::string> cancelled_by = {};
  std::optional<std::string> checkpoint = {};  ///< JSON

  /// As callers see it.
  api::JobState public_state() const {
    return state == api::JobState::kRunning && cancelled_by ? api::JobState::kCancelling : state;
  }
};

/// The job with this number, which is there.
StatusOr<JobRow> ReadJobRow(Connection& db, int64_t number);
/// Errors: kNotFound JOB_NOT_FOUND.
StatusOr<JobRow> FindJobRow(Connection& db, const std::string& tenant, const std::string& id);
Status JobNotFound(const std::string& id);

/// A job whose row was just made: counter of the tenant, event, listener.
void RecordCreation(Transaction& t, const JobRow& job);

/// Brings `job` from its state into another: row, counters of the tenant, event, listener. Its
/// attempt, budgets, start and retry times are stored with it.
void ChangeState(Transaction& t, JobRow& job, api::JobState to,
                 const std::optional<api::JobError>& error, const std::string& worker);

/// The wish to cancel a running job; it is CANCELLING from now on.
void MarkCancelling(Transaction& t, JobRow& job, const std::string& who);

/// An event with a checkpoint (JSON).
void RecordCheckpoint(Transaction& t, JobRow& job, const std::string& checkpoint);

/// An event with progress (JSON); beyond the policy's number every second one of the job goes.
void RecordProgress(Transaction& t, JobRow& job, const std::string& progress);

/// A terminal job goes, with all that belongs to it.
void RemoveJob(Transaction& t, const JobRow& job);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_STATE_H_
