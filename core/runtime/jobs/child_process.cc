#include "core/runtime/jobs/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <thread>
#include <utility>

namespace poise::jobs {
namespace {

// Descriptors of both sides; each is above those that the child puts its own at, so that moving one
// there never overwrites another.
struct Pipes {
  int channel = -1, child_channel = -1;
  int output = -1, child_output = -1;
  int failure = -1, child_failure = -1;  // tells an exec that failed
  int nothing = -1;                      // /dev/null

  ~Pipes() {
    for (const int descriptor :
         {channel, child_channel, output, child_output, failure, child_failure, nothing}) {
      if (descriptor >= 0) close(descriptor);
    }
  }
};

int MoveUp(int descriptor) {
  constexpr int kAboveChilds = 10;
  const int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, kAboveChilds);
  close(descriptor);
  return moved;
}

bool Open(Pipes& pipes) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
  pipes.channel = MoveUp(ends[0]);
  pipes.child_channel = MoveUp(ends[1]);
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  pipes.output = MoveUp(ends[0]);
  pipes.child_output = MoveUp(ends[1]);
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  pipes.failure = MoveUp(ends[0]);
  pipes.child_failure = MoveUp(ends[1]);
  pipes.nothing = MoveUp(open("/dev/null", O_RDWR | O_CLOEXEC));
  return pipes.nothing >= 0 && pipes.child_failure >= 0 &&
         fcntl(pipes.channel, F_SETFL, O_NONBLOCK) == 0 &&
         fcntl(pipes.output, F_SETFL, O_NONBLOCK) == 0;
}

std::vector<char*> Pointers(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

// The child between fork and exec: system calls only, as other threads of the parent may have held
// any lock.
struct Launch {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* folder;
  pid_t parent;
  const Pipes* pipes;

  [[noreturn]] void Run() const {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);  // it had died before that call
    dup2(pipes->nothing, STDIN_FILENO);
    dup2(pipes->child_output, STDOUT_FILENO);
    dup2(pipes->child_output, STDERR_FILENO);
    dup2(pipes->child_channel, ChildProcess::kChannelInChild);
    syscall(SYS_close_range, ChildProcess::kChannelInChild + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGTERM);
    if (chdir(folder) == 0) {
      // Not before: a handler of the parent would run here.
      sigprocmask(SIG_SETMASK, &blocked, nullptr);
      execve(program, arguments, environment);
    }
    const int error = errno;
    [[maybe_unused]] const ssize_t written = write(pipes->child_failure, &error, sizeof(error));
    _exit(127);
  }
};

pid_t Fork(const Launch& launch) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = fork();
  if (pid == 0) launch.Run();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return pid;
}

Status CannotStart(const ChildCommand& command, int error) {
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_START", "",
                         fmt::format("cannot start {} in {}: {}", command.program,
                                     command.folder.string(), strerror(error)));
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

std::string ChildExit::Describe() const {
  if (signal == 0) return fmt::format("ended with exit code {}", code);
  return fmt::format("was killed by signal {} ({})", signal, strsignal(signal));
}

StatusOr<std::unique_ptr<ChildProcess>> ChildProcess::Start(const ChildCommand& command) {
  Pipes pipes;
  if (!Open(pipes)) return CannotStart(command, errno);
  const std::vector<char*> arguments = Pointers(command.arguments);
  const std::vector<char*> environment = Pointers(command.environment);
  const pid_t pid = Fork({.program = command.program.c_str(),
                          .arguments = arguments.data(),
                          .environment = environment.data(),
                          .folder = command.folder.c_str(),
                          .parent = getpid(),
                          .pipes = &pipes});
  if (pid < 0) return CannotStart(command, errno);
  std::unique_ptr<ChildProcess> process(
      new ChildProcess(pid, std::exchange(pipes.channel, -1), std::exchange(pipes.output, -1)));
  close(std::exchange(pipes.child_failure, -1));
  int error = 0;  // the pipe closes without a word when exec succeeds
  if (read(pipes.failure, &error, sizeof(error)) > 0) return CannotStart(command, error);
  return process;
}

ChildProcess::~ChildProcess() {
  while (!Poll()) {
    Kill();
    std::this_thread::yield();
  }
  close(channel_);
  close(output_);
}

void ChildProcess::AskToStop() {
  if (!exit_) kill(pid_, SIGTERM);
}

void ChildProcess::Kill() {
  if (!exit_) kill(-pid_, SIGKILL);
}

std::optional<ChildExit> ChildProcess::Poll() {
  if (exit_) return exit_;
  siginfo_t info{};
  // Its number stays taken until wait4, so that no other group can have it when it is killed.
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0) {
    return std::nullopt;
  }
  Kill();
  int state = 0;
  rusage used{};
  if (wait4(pid_, &state, 0, &used) != pid_) return std::nullopt;
  exit_ = ChildExit{.signal = WIFSIGNALED(state) ? WTERMSIG(state) : 0,
                    .code = WIFEXITED(state) ? WEXITSTATUS(state) : 0,
                    .usage = {.cpu_seconds = Seconds(used.ru_utime) + Seconds(used.ru_stime),
                              .peak_memory_bytes = int64_t{used.ru_maxrss} << 10}};
  return exit_;
}

}  // namespace poise::jobs
