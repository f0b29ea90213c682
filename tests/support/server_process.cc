#include "tests/support/server_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/support/process_inspection.h"
#include "tests/support/test_server.h"

namespace poise::testing {
namespace {

std::string ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string ReadLine(int descriptor) {
  std::string line;
  for (char c; read(descriptor, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

}  // namespace

ServerProcess::ServerProcess(const std::vector<std::string>& flags) {
  std::vector<std::string> words = {POISE_POISED_PROGRAM};
  const auto set_unless_given = [&](const std::string& flag, const std::string& value) {
    if (std::find(flags.begin(), flags.end(), flag) != flags.end()) return;
    words.insert(words.end(), {flag, value});
  };
  set_unless_given("--data-dir", (folder_.path() / "data").string());
  set_unless_given("--listen", "127.0.0.1:0");
  words.insert(words.end(), flags.begin(), flags.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string log = (folder_.path() / "log").string();
  int output[2];
  if (pipe2(output, O_CLOEXEC) != 0) return;
  pid_ = fork();
  if (pid_ == 0) {
    dup2(output[1], STDOUT_FILENO);
    dup2(open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  close(output[1]);
  if (auto line = base::ParseJson(ReadLine(output[0]), "ready line"); line.ok()) ready_ = *line;
  close(output[0]);
}

ServerProcess::~ServerProcess() {
  if (pid_ <= 0) return;
  Signal(SIGKILL);
  Wait();
}

std::shared_ptr<grpc::Channel> ServerProcess::NewChannel() const { return ConnectTo(address()); }

void ServerProcess::Signal(int number) const { kill(pid_, number); }

int ServerProcess::Wait() {
  int status = 0;
  waitpid(pid_, &status, 0);
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string ServerProcess::Log() const { return ReadFile((folder_.path() / "log").string()); }

int64_t ServerProcess::ResidentBytes() const { return SizeOf(pid_).resident_bytes; }

double ServerProcess::CpuSeconds() const { return CpuSecondsOf(pid_); }

std::string ServerProcess::Environment(const std::string& name) const {
  std::istringstream variables(ReadFile("/proc/" + std::to_string(pid_) + "/environ"));
  for (std::string variable; std::getline(variables, variable, '\0');) {
    if (variable.starts_with(name + "=")) return variable.substr(name.size() + 1);
  }
  return "unset";
}

}  // namespace poise::testing
