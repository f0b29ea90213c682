#include "core/runtime/jobs/counting_runner.h"

#include <chrono>

namespace poise::jobs {

StatusOr<RunOutput> CountingRunner::Run(const RunInput& input, const JobContext& context) {
  const std::string& kind = input.spec.kind;
  base::Gauge& running =
      telemetry_.gauge("poise_worker_attempts_running", "Attempts that run now", {});
  running.Add(1);
  const auto begin = std::chrono::steady_clock::now();
  StatusOr<RunOutput> output = inner_->Run(input, context);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  running.Add(-1);
  telemetry_
      .counter("poise_worker_attempts_total", "Attempts that ended",
               {{"kind", kind},
                {"code", absl::StatusCodeToString(output.status().code())},
                {"reason", output.ok() ? "OK" : base::ErrorReason(output.status())}})
      .Increment();
  telemetry_
      .histogram("poise_worker_attempt_seconds", "From the start of an attempt to its end",
                 {{"kind", kind}})
      .Observe(elapsed.count());
  return output;
}

}  // namespace poise::jobs
