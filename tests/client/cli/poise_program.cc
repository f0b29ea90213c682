#include "tests/client/cli/poise_program.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <sstream>
#include <utility>

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

PoiseServer::PoiseServer(int workers)
    : process_({ProgramPath("poised"), "--listen", "127.0.0.1:0", "--workers",
                std::to_string(workers), "--lame-duck-seconds", "0", "--data-dir", Path("data")}) {
  EXPECT_TRUE(process_.WaitForOutput("\n", absl::Seconds(60))) << process_.ErrorOutput();
  const std::string ready = process_.Output();
  address_ = base::Json::parse(ready.substr(0, ready.find('\n'))).at("address");
}

void PoiseServer::Kill() {
  process_.Signal(SIGKILL);
  killed_ = true;
}

PoiseServer::~PoiseServer() {
  if (killed_) return;
  process_.Signal(SIGTERM);
  EXPECT_EQ(process_.Wait(), 0);
}

PoiseRun PoiseServer::Poise(std::vector<std::string> arguments) const {
  return RunPoise(std::move(arguments), {{"POISE_SERVER", address_}});
}

}  // namespace poise::testing
