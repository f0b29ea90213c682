#include <fmt/format.h>

#include <string>

#include "core/runtime/jobs/job_rules.h"
#include "core/runtime/jobs/sqlite_calls.h"
#include "core/runtime/jobs/sqlite_reading.h"
#include "core/runtime/jobs/sqlite_state.h"

namespace poise::jobs::sqlite {

StatusOr<api::Job> CancelJob(Transaction& t, const std::string& tenant, const std::string& id,
                             const std::string& who) {
  POISE_ASSIGN_OR_RETURN(JobRow job, FindJobRow(t.db, tenant, id));
  if (job.state == api::JobState::kQueued) {
    t.db.Run("UPDATE jobs SET cancelled_by = ? WHERE number = ?", who, job.number);
    job.retry_time = absl::InfiniteFuture();
    ChangeState(t, job, api::JobState::kCancelled, CancelledBy(who), "");
  } else if (job.state == api::JobState::kRunning && !job.cancelled_by) {
    MarkCancelling(t, job, who);
  }
  return LoadJob(t.db, tenant, id);
}

Status DeleteJob(Transaction& t, const std::string& tenant, const std::string& id) {
  POISE_ASSIGN_OR_RETURN(const JobRow job, FindJobRow(t.db, tenant, id));
  if (!api::IsTerminal(job.state)) {
    return base::FailedPrecondition(
        "JOB_NOT_TERMINAL", "name",
        fmt::format("job '{}' is {}: cancel it first", id, api::JobStateName(job.public_state())));
  }
  RemoveJob(t, job);
  return absl::OkStatus();
}

}  // namespace poise::jobs::sqlite
