#include "core/runtime/jobs/log_runner.h"

#include <chrono>
#include <string>

namespace poise::jobs {

StatusOr<RunOutput> LogRunner::Run(const RunInput& input, const JobContext& context) {
  base::Json fields = {{"job", input.job},
                       {"attempt", input.attempt},
                       {"kind", input.spec.kind},
                       {"trace_id", input.trace_id}};
  base::Json start = fields;
  start["from_step"] = input.checkpoint_step;
  log_("attempt_start", start);
  const auto begin = std::chrono::steady_clock::now();
  StatusOr<RunOutput> output = inner_->Run(input, context);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  fields["code"] = absl::StatusCodeToString(output.status().code());
  fields["seconds"] = elapsed.count();
  if (!output.ok()) {
    fields["reason"] = base::ErrorReason(output.status());
    fields["message"] = base::Message(output.status());
  }
  log_("attempt_end", fields);
  return output;
}

}  // namespace poise::jobs
