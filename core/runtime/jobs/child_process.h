#ifndef POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_H_
#define POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_H_

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/api/job.h"
#include "core/base/status.h"

namespace poise::jobs {

/// How a process is started.
struct ChildCommand {
  std::string program;
  std::vector<std::string> arguments;    ///< the first is the name that `ps` shows
  std::vector<std::string> environment;  ///< NAME=VALUE, all of it
  std::filesystem::path folder;          ///< where it starts
};

/// How a process ended.
struct ChildExit {
  int signal = 0;  ///< that killed it; 0: none
  int code = 0;    ///< when no signal did
  api::JobUsage usage;

  /// "was killed by signal 11 (Segmentation fault)"
  std::string Describe() const;
};

/// A process with a channel (a socket) to this one, in a process group of its own. It inherits the
/// channel as descriptor 3 and one pipe for its output and errors, nothing else; SIGTERM is blocked
/// in it until it says otherwise. The kernel kills it when the *thread* that started it ends.
/// Threads: one caller at a time.
class ChildProcess {
 public:
  static constexpr int kChannelInChild = 3;

  /// Errors: kUnavailable CANNOT_START.
  static StatusOr<std::unique_ptr<ChildProcess>> Start(const ChildCommand& command);
  /// Kills what still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  int channel() const { return channel_; }  ///< does not block
  int output() const { return output_; }    ///< does not block

  /// SIGTERM to the process.
  void AskToStop();
  /// SIGKILL to the whole group.
  void Kill();
  /// Whether it has ended, without waiting. Once it has, its group is killed too: what it started
  /// must not compute on.
  std::optional<ChildExit> Poll();

 private:
  ChildProcess(pid_t pid, int channel, int output)
      : pid_(pid), channel_(channel), output_(output) {}

  const pid_t pid_;
  const int channel_;
  const int output_;
  std::optional<ChildExit> exit_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_CHILD_PROCESS_H_
