#include "tests/client/cli/poise_program.h"

#include <sstream>

#include "tests/support/process.h"

namespace poise::testing {

std::vector<base::Json> PoiseRun::JsonLines() const {
  std::vector<base::Json> lines;
  std::istringstream stream(out);
  for (std::string line; std::getline(stream, line);) lines.push_back(base::Json::parse(line));
  return lines;
}

std::string ProgramPath(const std::string& name) { return std::string(POISE_BIN_DIR) + "/" + name; }

PoiseRun RunPoise(std::vector<std::string> arguments,
                  std::map<std::string, std::string> environment) {
  environment.try_emplace("POISE_SERVER", "127.0.0.1:1");  // a port that nobody listens on
  arguments.insert(arguments.begin(), ProgramPath("poise"));
  Process process(arguments, environment);
  const int exit_code = process.Wait().value_or(-1);
  return {.exit_code = exit_code, .out = process.Output(), .err = process.ErrorOutput()};
}

}  // namespace poise::testing
