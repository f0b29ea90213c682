#ifndef POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_RUNNER_H_

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// How a child process is watched.
struct ChildProcessConfig {
  std::string program;                   ///< calls ServeChild
  std::vector<std::string> arguments;    ///< the first is the name that `ps` shows
  std::vector<std::string> environment;  ///< NAME=VALUE, all of it

  absl::Duration stall_timeout = absl::Seconds(120);  ///< [> 0] longest time without a new step
  /// Between SIGTERM and SIGKILL. Asked again and again, so that it can become shorter meanwhile.
  std::function<absl::Duration()> stop_grace = [] { return absl::Seconds(1); };
  /// Between its result and its exit; then it is killed, and the result stands.
  absl::Duration exit_grace = absl::Seconds(5);
  /// How soon a wish to stop is seen.
  absl::Duration poll_interval = absl::Milliseconds(30);

  /// What it writes to its output and errors, line by line. May be empty.
  std::function<void(std::string_view line)> on_output;
  size_t max_output_line_bytes = 4096;          ///< longer lines are cut
  int max_output_lines = 1000;                  ///< later ones are counted only
  size_t max_message_bytes = size_t{64} << 20;  ///< of one line from the child
};

/// Runs an attempt in a child process, so that nothing it does can harm this one: the other side of
/// ServeChild. Asked to stop, the child gets SIGTERM, and SIGKILL when it does not heed it; then
/// the attempt ends with RunContext::Check. Whatever the child left running is killed with it.
/// Errors: the child's; kUnavailable PROCESS_LOST (crashed, killed, or ended without a result),
/// STALLED, CANNOT_START; kInternal CHILD_PROTOCOL; those of JobContext::save_checkpoint.
/// Threads: the child lives no longer than the thread that calls Run.
class ChildProcessRunner : public JobRunner {
 public:
  explicit ChildProcessRunner(ChildProcessConfig config) : config_(std::move(config)) {}

  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;

  /// Of the last run.
  const api::JobUsage& usage() const { return usage_; }

 private:
  const ChildProcessConfig config_;
  api::JobUsage usage_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_RUNNER_H_
