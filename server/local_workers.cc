#include "server/local_workers.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/time/clock.h"
#include "core/base/identifier.h"
#include "core/runtime/jobs/child_message.h"
#include "server/log.h"

namespace poise::server {
namespace {

constexpr size_t kMaxLineBytes = size_t{64} << 10;
constexpr int kLookMs = 50;
constexpr char kIdPrefix[] = "local-";

// Lines of the worker are such as this server's own.
void Forward(std::string line) {
  line += '\n';
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
}

// Waits a little, then forwards what has come; false when there was nothing.
bool ForwardLines(int output, jobs::LineBuffer& lines, int wait_ms) {
  pollfd waiting{.fd = output, .events = POLLIN, .revents = 0};
  poll(&waiting, 1, wait_ms);
  char block[4096];
  const ssize_t count = read(output, block, sizeof(block));
  if (count > 0) lines.Append({block, static_cast<size_t>(count)});
  while (auto line = lines.Next()) Forward(*std::move(line));
  if (count == 0) absl::SleepFor(absl::Milliseconds(wait_ms));  // closed: it is about to end
  return count > 0;
}

}  // namespace

std::string LoopbackAddress(const std::string& address) {
  for (const auto& [any, loopback] :
       {std::pair("0.0.0.0:", "127.0.0.1:"), std::pair("[::]:", "[::1]:")}) {
    if (address.starts_with(any)) return loopback + address.substr(std::string_view(any).size());
  }
  return address;
}

StatusOr<std::unique_ptr<LocalWorkers>> LocalWorkers::Start(LocalWorkersConfig config,
                                                            engine::JobManager& jobs) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto program = self.parent_path() / "poise-worker";
  if (access(program.c_str(), X_OK) != 0) {
    return base::FailedPrecondition(
        "NO_WORKER_PROGRAM", "workers",
        fmt::format("--workers needs the program {}, which is not there", program.string()));
  }
  return std::unique_ptr<LocalWorkers>(new LocalWorkers(std::move(config), program, jobs));
}

LocalWorkers::LocalWorkers(LocalWorkersConfig config, std::string program, engine::JobManager& jobs)
    : config_(std::move(config)),
      program_(std::move(program)),
      jobs_(jobs),
      thread_([this] { Run(); }) {}

LocalWorkers::~LocalWorkers() {
  Advance(Stage::kKill);
  thread_.join();
}

void LocalWorkers::Drain() { Advance(Stage::kDrain); }

LocalWorkers::Stage LocalWorkers::stage() const {
  std::lock_guard lock(mutex_);
  return stage_;
}

void LocalWorkers::Advance(Stage stage) {
  std::lock_guard lock(mutex_);
  stage_ = std::max(stage_, stage);
  changed_.notify_all();
}

void LocalWorkers::Run() {
  // Those of an earlier process on this store died with it.
  const StatusOr<int64_t> left = jobs_.ExpireWorkersNamed(kIdPrefix);
  if (left.ok() && *left > 0) Log(level::warn, "jobs_of_dead_workers", {{"jobs", *left}});
  absl::Duration pause = config_.first_pause;
  while (stage() == Stage::kWork) {
    const std::string id = kIdPrefix + base::RandomHex(6);
    const absl::Time start = absl::Now();
    RunOne(id);
    // Given back or finished already, unless it died.
    const StatusOr<int64_t> expired = jobs_.ExpireWorker(id);
    if (stage() != Stage::kWork) break;
    Log(level::err, "worker_died", {{"worker", id}, {"jobs", expired.ok() ? *expired : 0}});
    pause = absl::Now() - start < config_.young ? std::min(2 * pause, config_.longest_pause)
                                                : config_.first_pause;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, absl::ToChronoNanoseconds(pause),
                      [this] { return stage_ != Stage::kWork; });
  }
  ended_ = true;
}

void LocalWorkers::RunOne(const std::string& id) {
  const StatusOr<std::unique_ptr<jobs::ChildProcess>> process =
      jobs::ChildProcess::Start(Command(id));
  if (!process.ok()) {
    Log(level::err, "worker_not_started", {{"message", base::Message(process.status())}});
    return;
  }
  jobs::LineBuffer lines(kMaxLineBytes);
  std::optional<jobs::ChildExit> exit;
  for (bool asked = false; !exit; exit = (*process)->Poll()) {
    ForwardLines((*process)->output(), lines, kLookMs);
    if (stage() == Stage::kDrain && !std::exchange(asked, true)) (*process)->AskToStop();
    if (stage() == Stage::kKill) (*process)->Kill();
  }
  while (ForwardLines((*process)->output(), lines, 0)) {
  }
  Log(level::info, "worker_ended", {{"worker", id}, {"how", exit->Describe()}});
}

jobs::ChildCommand LocalWorkers::Command(const std::string& id) const {
  jobs::ChildCommand command{
      .program = program_,
      .arguments = {"poise-worker", "--server", LoopbackAddress(config_.server), "--slots",
                    std::to_string(config_.slots), "--engine", "local", "--id", id, "--work-dir",
                    std::filesystem::absolute(config_.work_dir).string(), "--log-level",
                    config_.log_level, "--drain-time",
                    fmt::format("{:.3f}s", absl::ToDoubleSeconds(config_.drain))},
      .environment = {},
      .folder = "/"};
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!std::string_view(*variable).starts_with("POISE_TOKEN=")) {
      command.environment.emplace_back(*variable);
    }
  }
  if (!config_.token.empty()) command.environment.push_back("POISE_TOKEN=" + config_.token);
  return command;
}

}  // namespace poise::server
