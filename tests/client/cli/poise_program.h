#ifndef POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_
#define POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_

#include <map>
#include <string>
#include <vector>

#include "core/base/json.h"

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

}  // namespace poise::testing

#endif  // POISE_TESTS_CLIENT_CLI_POISE_PROGRAM_H_
