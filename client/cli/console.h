#ifndef POISE_CLIENT_CLI_CONSOLE_H_
#define POISE_CLIENT_CLI_CONSOLE_H_

#include <string_view>

#include "client/cli/exit_code.h"
#include "core/base/json.h"
#include "core/base/status.h"

namespace poise::cli {

/// Where a command's words go. Results go to standard output: text, or with --json nothing but one
/// JSON object a line. Remarks for people go to standard error and are left out with --json.
class Console {
 public:
  explicit Console(bool json) : json_(json) {}

  /// The user asked for JSON.
  bool json() const { return json_; }
  /// Standard error is a terminal that understands a carriage return.
  static bool HasTerminal();

  /// A line of results.
  void Print(std::string_view line) const;
  void PrintJson(const base::Json& object) const;
  /// A remark.
  void Note(std::string_view line) const;

  /// Prints the error, if it is one, and gives the program's exit code. With --json the error is
  /// {"error": {"code", "reason", "message", "field"}} on standard output; nothing for the end of a
  /// job, which its own line tells.
  ExitCode Finish(const Status& status) const;

 private:
  bool json_;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_CONSOLE_H_
