#include "core/runtime/jobs/child_side.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <fstream>
#include <iterator>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/fail_point.h"
#include "core/runtime/jobs/child_message.h"
#include "core/runtime/jobs/child_process.h"

namespace poise::jobs {
namespace {

constexpr int kChannel = ChildProcess::kChannelInChild;

// Lives as long as the process: a signal may come at any time.
base::CancellationToken& StopWish() {
  static auto* const token = new base::CancellationToken;
  return *token;
}

void OnTerminate(int) { StopWish().Cancel(); }

void CatchTerminate() {
  StopWish();  // made before the handler needs it
  signal(SIGPIPE, SIG_IGN);
  struct sigaction action {};
  action.sa_handler = OnTerminate;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTERM, &action, nullptr);
  sigset_t terminate;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_UNBLOCK, &terminate, nullptr);
}

// When memory runs out, this process goes before the one that watches it.
void VolunteerForOutOfMemoryKiller() { std::ofstream("/proc/self/oom_score_adj") << 500; }

std::string ReadLine() {
  std::string line;
  char c = 0;
  while (true) {
    const ssize_t count = read(kChannel, &c, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || c == '\n') return line;
    line += c;
  }
}

// Writes to the channel. Of progress only the newest goes out, once per interval, by a thread of
// its own: the step at which the work hangs must be known too. Threads: any.
class Reporter {
 public:
  Reporter() : thread_([this] { SendProgressNowAndThen(); }) {}
  ~Reporter() {
    {
      std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  void Progress(const base::Progress& progress) {
    {
      std::lock_guard lock(mutex_);
      pending_ = progress;
      if (std::exchange(first_, false)) SendProgress();
    }
    changed_.notify_all();
  }

  void Send(const ChildMessage& message) {
    std::lock_guard lock(mutex_);
    SendProgress();
    Write(EncodeLine(message));
  }

 private:
  static constexpr std::chrono::milliseconds kProgressInterval{20};

  void SendProgressNowAndThen() {
    std::unique_lock lock(mutex_);
    while (!done_) {
      changed_.wait(lock, [this] { return done_ || pending_; });
      SendProgress();
      changed_.wait_for(lock, kProgressInterval, [this] { return done_; });
    }
  }

  void SendProgress() {
    if (pending_) Write(EncodeLine(ChildMessage(*pending_)));
    pending_.reset();
  }

  static void Write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = send(kChannel, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) _exit(1);  // nobody is there any more who could use the work
      bytes.remove_prefix(static_cast<size_t>(count));
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<base::Progress> pending_;
  bool first_ = true;
  bool done_ = false;
  std::thread thread_;
};

// The file has its name only once all of it is on disk.
Status WriteDurably(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path staging = path.string() + ".part";
  const int file = open(staging.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  bool written = file >= 0;
  while (written && !bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    written = count > 0 || (count < 0 && errno == EINTR);
    if (count > 0) bytes.remove_prefix(static_cast<size_t>(count));
  }
  written = written && fsync(file) == 0;
  if (file >= 0) close(file);
  base::FailPoint("child.before_checkpoint_rename");
  if (written && rename(staging.c_str(), path.c_str()) == 0) return absl::OkStatus();
  return base::MakeError(absl::StatusCode::kResourceExhausted, "CANNOT_WRITE", "",
                         fmt::format("cannot write {}", path.string()));
}

JobContext MakeContext(const ChildStart& start, Reporter& reporter) {
  JobContext context;
  context.run.seed = start.input.seed;
  context.run.cancellation = StopWish();
  if (start.deadline_in < absl::InfiniteDuration()) {
    context.run.deadline = absl::Now() + start.deadline_in;
  }
  context.run.progress = [&reporter](const base::Progress& p) { reporter.Progress(p); };
  context.checkpoint_interval = start.checkpoint_interval;
  context.save_checkpoint = [&reporter, folder = start.input.folder / kPrivateFolder, count = 0](
                                std::string_view bytes, int64_t step) mutable {
    const std::filesystem::path path = folder / fmt::format("checkpoint-{}", ++count);
    POISE_RETURN_IF_ERROR(WriteDurably(path, bytes));
    reporter.Send(ChildCheckpoint{.file = path, .step = step});
    return absl::OkStatus();
  };
  return context;
}

StatusOr<RunOutput> RunAttempt(const RunnerFactory& make_runner, ChildStart start,
                               Reporter& reporter) {
  if (!start.checkpoint_file.empty()) {
    std::ifstream stream(start.checkpoint_file, std::ios::binary);
    start.input.checkpoint = std::string(std::istreambuf_iterator<char>(stream), {});
  }
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<JobRunner> runner,
                         make_runner(start.input.spec.kind));
  try {
    return runner->Run(start.input, MakeContext(start, reporter));
  } catch (const std::bad_alloc&) {
    return base::ResourceExhausted("OUT_OF_MEMORY", "", "the job needs more memory than there is");
  } catch (const std::exception& error) {
    return base::Internal("UNCAUGHT_EXCEPTION", error.what());
  }
}

}  // namespace

int ServeChild(const RunnerFactory& make_runner) {
  fcntl(kChannel, F_SETFD, FD_CLOEXEC);
  CatchTerminate();
  prctl(PR_SET_NAME, "poise-job");
  VolunteerForOutOfMemoryKiller();
  const StatusOr<ChildStart> start = DecodeStart(ReadLine());
  if (!start.ok()) {
    fmt::print(stderr, "{}\n", base::Message(start.status()));
    return 2;
  }
  Reporter reporter;
  const StatusOr<RunOutput> output = RunAttempt(make_runner, *start, reporter);
  reporter.Send(output.ok() ? ChildMessage(*output)
                            : ChildMessage(api::JobError::From(output.status())));
  return 0;
}

}  // namespace poise::jobs
