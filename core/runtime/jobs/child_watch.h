#ifndef POISE_CORE_RUNTIME_JOBS_CHILD_WATCH_H_
#define POISE_CORE_RUNTIME_JOBS_CHILD_WATCH_H_

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "core/runtime/jobs/child_message.h"
#include "core/runtime/jobs/child_process.h"
#include "core/runtime/jobs/child_process_runner.h"

namespace poise::jobs {

/// One child process from its start to its end, for ChildProcessRunner.
class ChildWatch {
 public:
  ChildWatch(const ChildProcessConfig& config, const RunInput& input, const JobContext& context,
             std::unique_ptr<ChildProcess> process);

  /// Sends the line that starts the work, and watches until the process has ended.
  StatusOr<RunOutput> Run(const ChildStart& start);
  const ChildExit& exit() const { return exit_; }

 private:
  using Clock = std::chrono::steady_clock;

  void WaitForBytes();
  void SendStart();
  // Whether there was something to read.
  bool ReadChannel();
  bool ReadOutput();
  void Handle(const std::string& line);
  void TakeProgress(const base::Progress& progress);
  void TakeCheckpoint(const ChildCheckpoint& checkpoint);
  void ForwardOutput(std::string line);
  // Asks to stop, and kills: for stopping, stalling and a result without an exit.
  void Supervise();
  // The attempt cannot go on.
  void GiveUp(Status why);
  StatusOr<RunOutput> Conclude();

  const ChildProcessConfig& config_;
  const RunInput& input_;
  const JobContext& context_;
  const std::unique_ptr<ChildProcess> process_;
  LineBuffer channel_;
  LineBuffer output_;
  std::string to_send_;
  bool channel_open_ = true;
  bool output_open_ = true;
  int output_lines_ = 0;
  std::string last_output_line_;

  int64_t step_ = -1;
  Clock::time_point step_time_ = Clock::now();
  std::optional<Clock::time_point> stop_time_;  // of asking to stop
  std::optional<Clock::time_point> end_time_;   // of its last message
  std::optional<StatusOr<RunOutput>> result_;
  Status given_up_;
  ChildExit exit_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_CHILD_WATCH_H_
