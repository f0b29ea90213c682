// poise-worker: flags -> config -> Supervisor, until SIGTERM or SIGINT, or until there is nothing
// to do. With --child (not for people) the process of one attempt that needs no LibTorch.
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>

#include "core/base/exit_code.h"
#include "core/base/fail_point.h"
#include "core/base/identifier.h"
#include "core/base/json.h"
#include "core/base/memory_policy.h"
#include "core/base/version.h"
#include "core/engine/flow_table.h"
#include "core/runtime/jobs/child_side.h"
#include "server/log.h"
#include "server/shutdown_signal.h"
#include "server/telemetry/prometheus_telemetry.h"
#include "server/worker/supervisor.h"

namespace poise::worker {
namespace {

struct Options {
  WorkerConfig worker;
  std::string metrics;
  std::string log_level = "info";
};

// "60s", "2h30m", or a number of seconds.
void AddDuration(CLI::App& app, const std::string& name, absl::Duration& duration,
                 const std::string& help) {
  app.add_option_function<std::string>(
      name,
      [&duration, name](const std::string& text) {
        const bool plain = text.find_first_not_of("0123456789.") == std::string::npos;
        if (absl::ParseDuration(plain ? text + "s" : text, &duration) &&
            duration > absl::ZeroDuration()) {
          return;
        }
        throw CLI::ValidationError(name, fmt::format("'{}': expected a time like 60s or 2h", text));
      },
      help);
}

void AddFlags(Options& options, CLI::App& app) {
  WorkerConfig& worker = options.worker;
  app.add_option("--server", worker.client.server, "HOST:PORT of poised (else POISE_SERVER)")
      ->capture_default_str();
  app.add_option("--slots", worker.info.slots, "Jobs that run at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  AddDuration(app, "--idle-exit", worker.idle_exit, "End after this long without a job, as 60s");
  AddDuration(app, "--max-time", worker.max_time, "End after this long, giving back what runs");
  AddDuration(app, "--drain-time", worker.drain,
              "After SIGTERM: time to save and give back what runs (30s)");
  app.add_option("--queues", worker.queues, "Queues to serve, as a,b; none: all")->delimiter(',');
  app.add_option("--kinds", worker.kinds, "Kinds of jobs to take, as a,b; none: all")
      ->delimiter(',');
  app.add_option("--id", worker.info.id, "Name of this worker, never used before; none: made up");
  app.add_option("--engine", worker.info.engine, "What started it")
      ->check(CLI::IsMember({"local", "kubernetes", "slurm", "manual"}))
      ->capture_default_str();
  app.add_option("--engine-ref", worker.info.engine_ref, "Its pod, or its Slurm job");
  app.add_option("--work-dir", worker.work_dir, "Folder for files of running jobs")
      ->capture_default_str();
  app.add_option("--metrics", options.metrics, "ADDR:PORT of the Prometheus page; none: no page");
  app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
      ->capture_default_str();
}

Options Defaults() {
  Options options;
  WorkerConfig& worker = options.worker;
  worker.client = client::ClientOptions::FromEnvironment();
  // A transfer ends soon after the server; whether it is begun again depends on the lease.
  worker.client.outage = absl::Seconds(10);
  worker.info.engine = "manual";
  worker.info.version = base::Version();
  std::error_code ignored;
  worker.work_dir =
      std::filesystem::temp_directory_path(ignored) / fmt::format("poise-worker-{}", geteuid());
  worker.learner_program =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "poise-learner";
  return options;
}

std::string HostName() {
  char name[256] = "";
  return gethostname(name, sizeof(name) - 1) == 0 ? name : "unknown";
}

// What the flags leave open, and what they cannot check.
Status Complete(WorkerConfig& worker) {
  worker.info.host = HostName();
  if (worker.info.id.empty()) {
    worker.info.id = fmt::format("{}-{}-{}", worker.info.host, getpid(), base::RandomHex(4));
  }
  if (worker.info.id.find('/') != std::string::npos || worker.info.id.starts_with('.')) {
    return base::InvalidArgument("BAD_WORKER", "id", "a worker's name is no path");
  }
  if (access(worker.learner_program.c_str(), X_OK) != 0) {
    return base::FailedPrecondition(
        "NO_LEARNER_PROGRAM", "",
        fmt::format("the program {} is not there", worker.learner_program));
  }
  for (const std::string& kind : worker.kinds) {
    POISE_RETURN_IF_ERROR(engine::FindFlow(kind).status());
  }
  // Not "all": a newer server may have jobs that this build does not know.
  if (worker.kinds.empty()) {
    for (const engine::Flow& flow : engine::FlowTable()) worker.kinds.emplace_back(flow.kind);
  }
  return absl::OkStatus();
}

void PrintReady(const WorkerConfig& worker) {
  const base::Json ready = {{"event", "ready"},
                            {"worker", worker.info.id},
                            {"pid", getpid()},
                            {"server", worker.client.server},
                            {"slots", worker.info.slots},
                            {"version", base::Version()}};
  fmt::print("{}\n", ready.dump());
  std::fflush(stdout);
}

Status Work(Options options) {
  POISE_RETURN_IF_ERROR(server::StartLog(options.log_level));
  POISE_RETURN_IF_ERROR(Complete(options.worker));
  server::PrometheusTelemetry telemetry;
  if (!options.metrics.empty()) POISE_RETURN_IF_ERROR(telemetry.Expose(options.metrics));
  Supervisor supervisor(options.worker, telemetry, [&] { PrintReady(options.worker); });
  Status status;
  std::atomic<bool> done = false;
  std::thread runner([&] {
    status = supervisor.Run();
    done = true;
  });
  while (!done) {
    if (server::WaitForShutdownSignal(absl::Milliseconds(50))) supervisor.Stop();
  }
  runner.join();
  return status;
}

int ServeChild() { return jobs::ServeChild(engine::MakeLightRunner); }

// poised blocks it until this program can handle it.
void UnblockTerminate() {
  sigset_t terminate;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  pthread_sigmask(SIG_UNBLOCK, &terminate, nullptr);
}

int Main(int argc, char** argv) {
  base::SetFailPointsFromEnvironment();
  base::KeepFreedMemory();
  if (argc == 2 && std::strcmp(argv[1], "--child") == 0) return ServeChild();
  server::CatchShutdownSignals();
  UnblockTerminate();
  Options options = Defaults();
  CLI::App app{"poise-worker: runs jobs of a Poise server, each in a process of its own."};
  app.set_version_flag("--version", base::Version());
  AddFlags(options, app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const Status status = Work(std::move(options));
  if (!status.ok()) fmt::print(stderr, "poise-worker: {}\n", base::Message(status));
  return static_cast<int>(base::ExitCodeOf(status));
}

}  // namespace
}  // namespace poise::worker

int main(int argc, char** argv) { return poise::worker::Main(argc, argv); }
