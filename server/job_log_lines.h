#ifndef POISE_SERVER_JOB_LOG_LINES_H_
#define POISE_SERVER_JOB_LOG_LINES_H_

#include "core/engine/job_log.h"

namespace poise::server {

/// What happens to jobs, as log lines: "job_state" for each change of state, "job_task_failed".
class JobLogLines : public engine::JobLog {
 public:
  void OnTransition(const jobs::Transition& transition) override;
  void OnTaskFailed(std::string_view task, const Status& status) override;
};

}  // namespace poise::server

#endif  // POISE_SERVER_JOB_LOG_LINES_H_
