#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "absl/time/clock.h"

namespace poise::testing {
namespace {

constexpr absl::Duration kPoll = absl::Milliseconds(5);

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

void Redirect(const std::filesystem::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(file, descriptor);
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment) {
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  Redirect(folder_.path() / "out", STDOUT_FILENO);
  Redirect(folder_.path() / "err", STDERR_FILENO);
  execv(pointers[0], pointers.data());
  _exit(127);
}

Process::~Process() {
  if (exit_code_) return;
  kill(pid_, SIGKILL);
  Wait();
}

std::string Process::Output() const { return ReadAll(folder_.path() / "out"); }
std::string Process::ErrorOutput() const { return ReadAll(folder_.path() / "err"); }

bool Process::WaitForOutput(std::string_view text, absl::Duration timeout) {
  const absl::Time deadline = absl::Now() + timeout;
  while (Output().find(text) == std::string::npos) {
    if (absl::Now() > deadline) return false;
    if (Wait(kPoll)) return Output().find(text) != std::string::npos;
  }
  return true;
}

void Process::Signal(int signal) {
  if (!exit_code_) kill(pid_, signal);
}

std::optional<int> Process::Wait(absl::Duration timeout) {
  const absl::Time deadline = absl::Now() + timeout;
  while (!exit_code_) {
    int state = 0;
    if (waitpid(pid_, &state, WNOHANG) == pid_) {
      exit_code_ = WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
    } else if (absl::Now() > deadline) {
      return std::nullopt;
    } else {
      absl::SleepFor(kPoll);
    }
  }
  return exit_code_;
}

}  // namespace poise::testing
