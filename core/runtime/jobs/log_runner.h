#ifndef POISE_CORE_RUNTIME_JOBS_LOG_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_LOG_RUNNER_H_

#include <functional>
#include <memory>
#include <string_view>

#include "core/base/json.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// Where a program's log lines go: the engine has no log of its own.
using LogFunction = std::function<void(std::string_view event, const base::Json& fields)>;

/// Says when an attempt starts and how it ends: "attempt_start" and "attempt_end" with job,
/// attempt, kind and trace id; at the end also code, seconds and, of an error, reason and message.
class LogRunner : public JobRunner {
 public:
  LogRunner(std::unique_ptr<JobRunner> inner, LogFunction log)
      : inner_(std::move(inner)), log_(std::move(log)) {}

  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;

 private:
  const std::unique_ptr<JobRunner> inner_;
  const LogFunction log_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_LOG_RUNNER_H_
