#include "server/poised_options.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

namespace poise::server {
namespace {

// Where an installed program finds them, else one that was built in its source tree; empty: none.
std::filesystem::path DefaultShippedModels() {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"../share/poise/models", "../../../models"}) {
    const auto models = std::filesystem::weakly_canonical(folder / place, error);
    if (!error && std::filesystem::is_directory(models, error)) return models;
  }
  return {};
}

void AddServerFlags(PoisedOptions& options, CLI::App& app) {
  app.add_option("--listen", options.server.listen, "ADDR:PORT to serve on; port 0: any free one")
      ->capture_default_str();
  app.add_option("--data-dir", options.engine.data_dir,
                 "Folder for artifacts, jobs, models and data sets")
      ->capture_default_str();
  options.engine.shipped_models = DefaultShippedModels();
  app.add_option("--shipped-models", options.engine.shipped_models,
                 "Folder of models that came with the program; they are read only")
      ->capture_default_str();
  app.add_option("--compute-threads", options.engine.compute_threads,
                 "Threads that make variants; 0: one per CPU")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--metrics", options.metrics, "ADDR:PORT of the Prometheus page; empty: none");
  app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
      ->capture_default_str();
  app.add_option("--token-file", options.token_file,
                 "File with the token that calls must carry (else POISE_TOKEN, if set)")
      ->check(CLI::ExistingFile);
}

void AddLimitFlags(PoisedOptions& options, CLI::App& app) {
  app.add_option("--max-calls", options.server.admission.max_calls, "Calls at work at a time")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--max-calls-per-client", options.server.admission.max_calls_per_peer,
                 "Calls at work at a time from one address")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  app.add_option("--max-waiting-calls", options.server.admission.max_waiting_calls,
                 "Watches and workers that wait, at a time; they have places of their own")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--max-output-frames", options.engine.max_output_frames,
                 "Variants times frames that one request may ask for")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void AddDrainFlags(PoisedOptions& options, CLI::App& app) {
  app.add_option("--lame-duck-seconds", options.lame_duck_s,
                 "After SIGTERM: time to serve on, announced as not serving")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--drain-seconds", options.drain_s, "Then: time for running calls to finish")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  app.add_option("--takeover-seconds", options.takeover_s,
                 "At the start: time to wait for another poised to let go of the data folder")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
}

// A flag in `unit`s for a duration; its default is the duration's.
void AddDuration(CLI::App& app, const std::string& name, absl::Duration& duration,
                 absl::Duration unit, const std::string& help) {
  app.add_option_function<double>(
         name, [&duration, unit](const double& value) { duration = value * unit; }, help)
      ->check(CLI::Range(0.001, 1e6))
      ->default_str(fmt::format("{:g}", absl::FDivDuration(duration, unit)));
}

void AddServingFlags(serving::ServingConfig& config, CLI::App& app) {
  app.add_option("--predict-max-batch", config.max_batch,
                 "Motions that one forward pass of a predictor takes together; 1: no batching")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  AddDuration(app, "--predict-max-delay-ms", config.max_added_delay, absl::Milliseconds(1),
              "Longest that a prediction waits to be made together with others");
  app.add_option("--predict-max-requests", config.max_requests,
                 "Predictions by one model at work or waiting; more are refused")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
}

std::pair<std::string, double> ParseWeight(const std::string& text) {
  const size_t equals = text.find('=');
  try {
    size_t used = 0;
    const double weight =
        equals == std::string::npos ? -1 : std::stod(text.substr(equals + 1), &used);
    if (equals > 0 && weight > 0 && weight < 1e9 && equals + 1 + used == text.size()) {
      return {text.substr(0, equals), weight};
    }
  } catch (const std::exception&) {
    // Said below.
  }
  throw CLI::ValidationError("--tenant-weight", fmt::format("'{}': expected NAME=WEIGHT, the "
                                                            "weight above 0",
                                                            text));
}

void AddTenantFlags(jobs::JobPolicy& policy, CLI::App& app) {
  app.add_option("--max-queued-per-tenant", policy.max_queued_per_tenant,
                 "Jobs of one tenant that may wait")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--max-running-per-tenant", policy.max_running_per_tenant,
                 "Jobs of one tenant that may run")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--max-unfinished-jobs", policy.max_unfinished,
                 "Jobs that may wait or run, of all tenants")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option_function<std::vector<std::string>>(
         "--tenant-weight",
         [&policy](const std::vector<std::string>& weights) {
           for (const std::string& weight : weights)
             policy.tenant_weights.insert(ParseWeight(weight));
         },
         "NAME=W: a tenant's share of the running jobs; others have 1 (may be repeated)")
      ->take_all();
}

void AddJobFlags(PoisedOptions& options, CLI::App& app) {
  app.add_option("--workers", options.workers, "Worker processes for long jobs on this machine")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--store", options.store, "Where jobs are kept: sqlite")->capture_default_str();
  jobs::JobPolicy& policy = options.engine.jobs.policy;
  AddDuration(app, "--lease-seconds", policy.lease, absl::Seconds(1),
              "A worker that is not heard of for this long has lost its job");
  AddDuration(app, "--heartbeat-seconds", policy.heartbeat_interval, absl::Seconds(1),
              "How often workers are to be heard of");
  AddDuration(app, "--reap-seconds", options.engine.jobs.reap_interval, absl::Seconds(1),
              "How often lost workers are looked for");
  AddDuration(app, "--first-backoff-seconds", policy.first_backoff, absl::Seconds(1),
              "Longest pause before the second attempt; doubled for each one more");
  AddDuration(app, "--max-backoff-seconds", policy.max_backoff, absl::Seconds(1),
              "Longest pause before any attempt");
  AddDuration(app, "--retention-days", policy.retention, absl::Hours(24),
              "How long a job that ended and its results are kept");
  AddTenantFlags(policy, app);
}

}  // namespace

void AddFlags(PoisedOptions& options, CLI::App& app) {
  AddServerFlags(options, app);
  AddLimitFlags(options, app);
  AddServingFlags(options.engine.serving, app);
  AddJobFlags(options, app);
  AddDrainFlags(options, app);
}

StatusOr<std::string> ReadToken(const PoisedOptions& options) {
  std::string token;
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!(file >> token)) {
      return base::FailedPrecondition("BAD_TOKEN_FILE", "token_file",
                                      fmt::format("{} holds no token", options.token_file));
    }
  } else if (const char* variable = std::getenv("POISE_TOKEN")) {
    token = variable;
  }
  return token;
}

}  // namespace poise::server
