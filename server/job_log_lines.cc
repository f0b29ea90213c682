#include "server/job_log_lines.h"

#include "server/log.h"

namespace poise::server {

void JobLogLines::OnTransition(const jobs::Transition& transition) {
  Log(level::info, "job_state",
      {{"job", transition.job},
       {"kind", transition.kind},
       {"tenant", transition.tenant},
       {"from", transition.from ? api::JobStateName(*transition.from) : ""},
       {"to", api::JobStateName(transition.to)},
       {"attempt", transition.attempt},
       {"worker", transition.worker},
       {"trace_id", transition.trace_id},
       {"reason", transition.error ? transition.error->reason : ""},
       {"in_state_ms", absl::ToInt64Milliseconds(transition.in_state)}});
}

void JobLogLines::OnTaskFailed(std::string_view task, const Status& status) {
  Log(level::err, "job_task_failed",
      {{"task", task}, {"reason", base::ErrorReason(status)}, {"message", base::Message(status)}});
}

}  // namespace poise::server
