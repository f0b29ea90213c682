// poised: flags -> config -> Engine -> Server, until SIGTERM or SIGINT.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <thread>

#include "absl/time/clock.h"
#include "core/base/json.h"
#include "core/base/memory_policy.h"
#include "core/base/version.h"
#include "core/engine/engine.h"
#include "core/learning/nn/blas_probe.h"
#include "server/log.h"
#include "server/server.h"
#include "server/shutdown_signal.h"
#include "server/telemetry/prometheus_telemetry.h"

namespace poise::server {
namespace {

struct Options {
  ServerConfig server;
  engine::EngineConfig engine{.data_dir = "poise-data"};
  int workers = 0;
  std::string store = "sqlite";
  std::string metrics;
  std::string log_level = "info";
  std::string token_file;
  double lame_duck_s = 5;
  double drain_s = 25;
};

void AddFlags(Options& options, CLI::App& app) {
  app.add_option("--listen", options.server.listen, "ADDR:PORT to serve on; port 0: any free one")
      ->capture_default_str();
  app.add_option("--data-dir", options.engine.data_dir, "Folder for artifacts and jobs")
      ->capture_default_str();
  app.add_option("--compute-threads", options.engine.compute_threads,
                 "Threads that make variants; 0: one per CPU")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--workers", options.workers, "Worker processes for long jobs on this machine")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--store", options.store, "Where jobs are kept: sqlite")->capture_default_str();
  app.add_option("--metrics", options.metrics, "ADDR:PORT of the Prometheus page; empty: none");
  app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
      ->capture_default_str();
  app.add_option("--token-file", options.token_file,
                 "File with the token that calls must carry (else POISE_TOKEN, if set)")
      ->check(CLI::ExistingFile);
  app.add_option("--max-calls", options.server.admission.max_calls, "Calls at work at a time")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--max-calls-per-client", options.server.admission.max_calls_per_peer,
                 "Calls at work at a time from one address")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--max-output-frames", options.engine.max_output_frames,
                 "Variants times frames that one request may ask for")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--lame-duck-seconds", options.lame_duck_s,
                 "After SIGTERM: time to serve on, announced as not serving")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--drain-seconds", options.drain_s, "Then: time for running calls to finish")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
}

Status ReadToken(const Options& options, std::string& token) {
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!(file >> token)) {
      return base::FailedPrecondition("BAD_TOKEN_FILE", "token_file",
                                      fmt::format("{} holds no token", options.token_file));
    }
  } else if (const char* variable = std::getenv("POISE_TOKEN")) {
    token = variable;
  }
  return absl::OkStatus();
}

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

// NOT_SERVING, serve on for the lame-duck time, then let calls finish. A second signal hurries.
void Drain(const Options& options, Server& server) {
  const absl::Duration lame_duck = absl::Seconds(options.lame_duck_s);
  const absl::Duration drain = absl::Seconds(options.drain_s);
  constexpr absl::Duration kMargin = absl::Seconds(10);
  Log(level::info, "draining", {{"calls", server.calls()}});
  server.AnnounceShutdown();
  const Watchdog watchdog(lame_duck + drain + kMargin);
  const bool hurry = WaitForShutdownSignal(lame_duck);
  server.Shutdown(hurry ? absl::Now() : absl::Now() + drain);
  Log(level::info, "stopped");
}

Status Serve(Options options) {
  POISE_RETURN_IF_ERROR(StartLog(options.log_level));
  if (options.store != "sqlite") {
    return base::InvalidArgument(
        "UNKNOWN_STORE", "store",
        fmt::format("this version keeps no jobs in '{}', expected sqlite", options.store));
  }
  POISE_RETURN_IF_ERROR(ReadToken(options, options.server.admission.token));
  PrometheusTelemetry telemetry;
  if (!options.metrics.empty()) POISE_RETURN_IF_ERROR(telemetry.Expose(options.metrics));
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<engine::Engine> engine,
                         engine::Engine::Create(options.engine, telemetry));
  const double gflops = learning::MeasureSgemmGflops();
  telemetry.gauge("poise_sgemm_gflops_per_core", "Matrix product rate at start", {}).Set(gflops);
  if (gflops < learning::kFaultySgemmGflops) {
    Log(level::warn, "slow_blas",
        {{"sgemm_gflops_per_core", gflops},
         {"message", "install OpenBLAS: LibTorch runs on a slow BLAS here"}});
  }
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<Server> server,
                         Server::Start(options.server, *engine, telemetry));
  const base::Json ready = {{"event", "ready"},
                            {"address", server->address()},
                            {"pid", getpid()},
                            {"version", base::Version()},
                            {"sgemm_gflops_per_core", std::round(gflops * 10) / 10}};
  fmt::print("{}\n", ready.dump());
  std::fflush(stdout);
  WaitForShutdownSignal();
  Drain(options, *server);
  return absl::OkStatus();
}

// The exit codes of all Poise programs.
int ExitCode(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
      return 0;
    case absl::StatusCode::kInvalidArgument:
      return 2;
    case absl::StatusCode::kFailedPrecondition:
      return 4;
    default:
      return 1;
  }
}

int Main(int argc, char** argv) {
  base::KeepFreedMemory();
  CatchShutdownSignals();
  Options options;
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
  return ExitCode(status.code());
}

}  // namespace
}  // namespace poise::server

int main(int argc, char** argv) { return poise::server::Main(argc, argv); }
