#include "core/runtime/jobs/selftest_runner.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <new>
#include <stdexcept>
#include <thread>

#include "core/base/json.h"
#include "core/base/random.h"
#include "core/base/sha256.h"
#include "core/runtime/jobs/selftest_config.h"

namespace poise::jobs {
namespace {

using Clock = std::chrono::steady_clock;

// What goes on from attempt to attempt.
struct State {
  int64_t step = 0;
  std::string digest;  // of all steps so far
};

std::string Encode(const State& state) {
  return base::Json{{"step", state.step}, {"digest", state.digest}}.dump();
}

StatusOr<State> Decode(std::string_view bytes) {
  const StatusOr<base::Json> json = base::ParseJson(bytes, "checkpoint");
  if (json.ok() && json->is_object() && json->contains("step") && json->contains("digest") &&
      (*json)["step"].is_number_integer() && (*json)["digest"].is_string()) {
    return State{(*json)["step"], (*json)["digest"]};
  }
  return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_CHECKPOINT", "",
                         "the checkpoint is none of a selftest");
}

void Spend(std::chrono::milliseconds time, bool busy) {
  if (!busy) {
    std::this_thread::sleep_for(time);
    return;
  }
  for (const auto end = Clock::now() + time; Clock::now() < end;) {
  }
}

[[noreturn]] void Crash(int signal_number) {
  signal(signal_number, SIG_DFL);
  raise(signal_number);
  std::abort();
}

[[noreturn]] void Hang(bool busy) {
  while (true) Spend(std::chrono::milliseconds(100), busy);
}

// Returns for those failures that are a status.
Status Fail(const SelftestConfig& config, int64_t step) {
  const std::string& failure = config.failure;
  if (failure == "crash") Crash(SIGABRT);
  if (failure == "segfault") Crash(SIGSEGV);
  if (failure == "exit") _exit(3);
  if (failure == "hang") Hang(config.busy);
  if (failure == "throw") throw std::runtime_error("an exception, as asked for");
  if (failure == "out_of_memory") throw std::bad_alloc();
  const std::string message = fmt::format("failed after step {}, as asked for", step);
  if (failure == "invalid") return base::InvalidArgument("SELFTEST_INVALID", "", message);
  if (failure == "diverge") {
    return base::MakeError(absl::StatusCode::kOutOfRange, "DIVERGED", "", message);
  }
  return base::MakeError(absl::StatusCode::kUnavailable, "SELFTEST_UNAVAILABLE", "", message);
}

// Says when a checkpoint is due: every so many steps, or after so much time.
class CheckpointClock {
 public:
  CheckpointClock(int64_t every, absl::Duration interval)
      : every_(every), interval_(absl::ToChronoNanoseconds(interval)) {}

  bool Due(int64_t step) {
    if (every_ > 0) return step % every_ == 0;
    if (Clock::now() - last_ < interval_) return false;
    last_ = Clock::now();
    return true;
  }

 private:
  const int64_t every_;
  const std::chrono::nanoseconds interval_;
  Clock::time_point last_ = Clock::now();
};

StatusOr<OutputFile> WriteArtifact(const std::filesystem::path& folder, const State& state,
                                   int index, int64_t size) {
  OutputFile file;
  file.name = fmt::format("output/{:04}.bin", index);
  file.path = folder / file.name;
  std::error_code ignored;
  std::filesystem::create_directories(file.path.parent_path(), ignored);
  std::string bytes;
  bytes.reserve(static_cast<size_t>(size) + 64);
  for (uint64_t block = 0; static_cast<int64_t>(bytes.size()) < size; ++block) {
    bytes += base::Sha256Hex(fmt::format("{} {} {}", state.digest, index, block));
  }
  bytes.resize(static_cast<size_t>(size));
  std::ofstream stream(file.path, std::ios::binary);
  stream << bytes;
  stream.close();
  if (stream.good()) return file;
  return base::MakeError(absl::StatusCode::kResourceExhausted, "CANNOT_WRITE", "",
                         fmt::format("cannot write {}", file.path.string()));
}

}  // namespace

StatusOr<RunOutput> SelftestRunner::Run(const RunInput& input, const JobContext& context) {
  POISE_ASSIGN_OR_RETURN(const SelftestConfig config,
                         SelftestConfig::FromParameters(input.spec.parameters));
  State state{.step = 0, .digest = base::Sha256Hex(fmt::format("selftest {}", input.seed))};
  if (input.checkpoint) {
    POISE_ASSIGN_OR_RETURN(state, Decode(*input.checkpoint));
  }
  CheckpointClock checkpoint(config.checkpoint_every, context.checkpoint_interval);
  context.run.Report({.step = state.step, .total = config.steps, .message = "stepping"});
  while (state.step < config.steps) {
    if (const Status stop = context.run.Check(); !stop.ok() && config.on_stop == "obey") {
      POISE_RETURN_IF_ERROR(context.save_checkpoint(Encode(state), state.step));
      return stop;
    }
    Spend(std::chrono::milliseconds(config.step_ms), config.busy);
    ++state.step;
    state.digest = base::Sha256Hex(fmt::format("{} {}", state.digest, state.step));
    context.run.Report({.step = state.step, .total = config.steps, .message = "stepping"});
    // Before the checkpoint: an attempt that goes on from it comes here again.
    if (state.step == config.fail_at && input.attempt <= config.fail_attempts) {
      return Fail(config, state.step);
    }
    if (checkpoint.Due(state.step)) {
      POISE_RETURN_IF_ERROR(context.save_checkpoint(Encode(state), state.step));
    }
  }
  RunOutput output;
  for (int i = 0; i < config.artifacts; ++i) {
    POISE_ASSIGN_OR_RETURN(OutputFile file,
                           WriteArtifact(input.folder, state, i, config.artifact_bytes));
    output.files.push_back(std::move(file));
  }
  return output;
}

std::unique_ptr<JobRunner> MakeSelftestRunner() { return std::make_unique<SelftestRunner>(); }

}  // namespace poise::jobs
