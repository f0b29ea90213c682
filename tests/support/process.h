#ifndef POISE_TESTS_SUPPORT_PROCESS_H_
#define POISE_TESTS_SUPPORT_PROCESS_H_

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// A program that runs beside the test, with its output kept in files. It is killed when the object
/// goes away.
class Process {
 public:
  /// `arguments[0]` is the program's path; `environment` is added to the test's own.
  explicit Process(const std::vector<std::string>& arguments,
                   const std::map<std::string, std::string>& environment = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }

  /// What it has written so far.
  std::string Output() const;
  std::string ErrorOutput() const;

  /// Waits until standard output holds `text`; false when it ends or the time is over before.
  bool WaitForOutput(std::string_view text, absl::Duration timeout);
  void Signal(int signal);
  /// Exit code, or minus the signal that ended it; nullopt when it still runs after `timeout`.
  std::optional<int> Wait(absl::Duration timeout = absl::Seconds(60));

 private:
  TemporaryFolder folder_;
  pid_t pid_;
  std::optional<int> exit_code_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_PROCESS_H_
