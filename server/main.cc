// poised: flags -> config -> Engine -> Server, until SIGTERM or SIGINT.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "absl/time/clock.h"
#include "core/base/exit_code.h"
#include "core/base/fail_point.h"
#include "core/base/json.h"
#include "core/base/memory_policy.h"
#include "core/base/version.h"
#include "core/engine/compute_check.h"
#include "core/engine/engine.h"
#include "core/pipeline/load_decoder.h"
#include "server/job_log_lines.h"
#include "server/local_workers.h"
#include "server/log.h"
#include "server/poised_options.h"
#include "server/server.h"
#include "server/shutdown_signal.h"
#include "server/telemetry/prometheus_telemetry.h"

namespace poise::server {
namespace {

// Ends the process when draining takes longer than it may: a handler that ignores its cancellation
// must not keep an orchestrator waiting.
class Watchdog {
 public:
  explicit Watchdog(absl::Duration budget) : thread_([this, budget] { Run(budget); }) {}
  ~Watchdog() {
    {
      std::lock_guard lock(mutex_);
      done_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

 private:
  void Run(absl::Duration budget) {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, absl::ToChronoMilliseconds(budget), [this] { return done_; })) {
      return;
    }
    Log(level::err, "drain_budget_over");
    _exit(0);
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
  std::thread thread_;
};

// NOT_SERVING, serve on for the lame-duck time and until the workers of this machine have given
// their jobs back, then let calls finish. A second signal hurries.
void Drain(const PoisedOptions& options, Server& server, LocalWorkers* workers) {
  constexpr absl::Duration kMargin = absl::Seconds(10);
  constexpr absl::Duration kLook = absl::Milliseconds(50);
  const absl::Duration lame_duck = absl::Seconds(options.lame_duck_s);
  const absl::Duration drain = absl::Seconds(options.drain_s);
  Log(level::info, "draining", {{"calls", server.calls()}});
  server.AnnounceShutdown();
  if (workers != nullptr) workers->Drain();
  const Watchdog watchdog(lame_duck + drain + kMargin);
  bool hurry = WaitForShutdownSignal(lame_duck);
  const absl::Time end = absl::Now() + drain;
  while (workers != nullptr && !workers->ended() && !hurry && absl::Now() < end) {
    hurry = WaitForShutdownSignal(kLook);
  }
  server.Shutdown(hurry ? absl::Now() : end);
  Log(level::info, "stopped");
}

// Null when none are wanted.
StatusOr<std::unique_ptr<LocalWorkers>> StartWorkers(const PoisedOptions& options,
                                                     const Server& server,
                                                     engine::JobManager& jobs) {
  if (options.workers == 0) return nullptr;
  return LocalWorkers::Start({.slots = options.workers,
                              .server = server.address(),
                              .token = options.server.admission.token,
                              .log_level = options.log_level,
                              .work_dir = options.engine.data_dir / "work",
                              .drain = absl::Seconds(options.lame_duck_s + options.drain_s)},
                             jobs);
}

// Waits for another process to let go of the data folder, for --takeover-seconds at most. Null:
// the wait was ended by a signal.
StatusOr<std::unique_ptr<engine::Engine>> TakeOver(const PoisedOptions& options,
                                                   base::Telemetry& telemetry) {
  constexpr absl::Duration kPause = absl::Milliseconds(50);
  const absl::Time end = absl::Now() + absl::Seconds(options.takeover_s);
  for (bool said = false;; said = true) {
    auto engine = engine::Engine::Create(options.engine, telemetry);
    const bool in_use = base::ErrorReason(engine.status()) == "STORE_IN_USE";
    if (!in_use || absl::Now() >= end) return engine;
    if (!said) Log(level::info, "waiting_for_store", {{"message", base::Message(engine.status())}});
    if (WaitForShutdownSignal(kPause)) return nullptr;
  }
}

Status Serve(PoisedOptions options) {
  POISE_RETURN_IF_ERROR(StartLog(options.log_level));
  if (options.store != "sqlite") {
    return base::InvalidArgument(
        "UNKNOWN_STORE", "store",
        fmt::format("this version keeps no jobs in '{}', expected sqlite", options.store));
  }
  POISE_ASSIGN_OR_RETURN(options.server.admission.token, ReadToken(options));
  PrometheusTelemetry telemetry;
  JobLogLines job_log;
  options.engine.jobs.log = &job_log;
  options.engine.load_decoder = pipeline::LoadDecoder;
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<engine::Engine> engine,
                         TakeOver(options, telemetry));
  if (engine == nullptr) return absl::OkStatus();
  if (!options.metrics.empty()) POISE_RETURN_IF_ERROR(telemetry.Expose(options.metrics));
  const engine::ComputeCheck compute = engine::CheckCompute();
  const double gflops = compute.sgemm_gflops_per_core;
  telemetry.gauge("poise_sgemm_gflops_per_core", "Matrix product rate at start", {}).Set(gflops);
  if (compute.slow) {
    Log(level::warn, "slow_blas",
        {{"sgemm_gflops_per_core", gflops},
         {"message", "install OpenBLAS: LibTorch runs on a slow BLAS here"}});
  }
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<Server> server,
                         Server::Start(options.server, *engine, telemetry));
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<LocalWorkers> workers,
                         StartWorkers(options, *server, engine->jobs()));
  const base::Json ready = {{"event", "ready"},
                            {"address", server->address()},
                            {"pid", getpid()},
                            {"version", base::Version()},
                            {"sgemm_gflops_per_core", std::round(gflops * 10) / 10}};
  fmt::print("{}\n", ready.dump());
  std::fflush(stdout);
  WaitForShutdownSignal();
  Drain(options, *server, workers.get());
  return absl::OkStatus();
}

int Main(int argc, char** argv) {
  base::SetFailPointsFromEnvironment();
  base::KeepFreedMemory();
  CatchShutdownSignals();
  PoisedOptions options;
  CLI::App app{"poised: the Poise server. Motion clips in, variants out, over gRPC."};
  app.set_version_flag("--version", base::Version());
  AddFlags(options, app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const Status status = Serve(std::move(options));
  if (!status.ok()) fmt::print(stderr, "poised: {}\n", base::Message(status));
  return static_cast<int>(base::ExitCodeOf(status));
}

}  // namespace
}  // namespace poise::server

int main(int argc, char** argv) { return poise::server::Main(argc, argv); }
