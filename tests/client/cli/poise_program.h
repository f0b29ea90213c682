#ifndef POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_
#define POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_

#include <map>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// What one run of `poise` said.
struct PoiseRun {
  int exit_code = -1;
  std::string out;
  std::string err;

  /// The lines of standard output, as JSON.
  std::vector<base::Json> JsonLines() const;
  /// The error object of the last line.
  base::Json Error() const { return JsonLines().back().at("error"); }
};

/// The path of a program of this build: "poise".
std::string ProgramPath(const std::string& name);

/// Runs `poise ARGUMENTS...` to its end. No server is there unless the environment names one.
PoiseRun RunPoise(std::vector<std::string> arguments,
                  std::map<std::string, std::string> environment = {});

/// A real poised for one test program or test, with a data folder of its own, and `poise` against
/// it. Construction expects it to become ready; destruction expects a clean end.
class PoiseServer {
 public:
  /// `workers` processes of jobs at a time.
  explicit PoiseServer(int workers);
  ~PoiseServer();
  PoiseServer(const PoiseServer&) = delete;
  PoiseServer& operator=(const PoiseServer&) = delete;

  const std::string& address() const { return address_; }
  /// As by a crash; then no clean end is expected.
  void Kill();
  /// Below the server's folder, for the files of tests.
  std::string Path(const std::string& below) const { return (folder_.path() / below).string(); }
  PoiseRun Poise(std::vector<std::string> arguments) const;

 private:
  TemporaryFolder folder_;
  Process process_;
  std::string address_;
  bool killed_ = false;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_
