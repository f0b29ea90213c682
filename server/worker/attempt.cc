#include "server/worker/attempt.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include "core/base/fail_point.h"
#include "core/engine/flow_table.h"
#include "core/runtime/jobs/child_message.h"
#include "core/runtime/jobs/counting_runner.h"
#include "core/runtime/jobs/deadline_runner.h"
#include "core/runtime/jobs/job_json.h"
#include "core/runtime/jobs/log_runner.h"
#include "core/runtime/jobs/manifest_runner.h"
#include "server/log.h"
#include "server/worker/child_environment.h"
#include "server/worker/persistence.h"

namespace poise::worker {
namespace {

using server::Log;
namespace level = server::level;

LeaseKeeperConfig KeeperConfig(absl::Duration heartbeat_interval) {
  LeaseKeeperConfig config;
  config.heartbeat_interval = heartbeat_interval;
  config.shortest_interval = std::min(config.shortest_interval, heartbeat_interval);
  return config;
}

void LogInfo(std::string_view event, const base::Json& fields) { Log(level::info, event, fields); }

}  // namespace

jobs::Outcome FailureOutcome(const Status& status, const api::JobUsage& usage) {
  jobs::Outcome outcome{
      .outcome = api::AttemptOutcome::kError, .error = api::JobError::From(status), .usage = usage};
  const std::string reason = base::ErrorReason(status);
  if (reason == "STALLED") outcome.outcome = api::AttemptOutcome::kStalled;
  if (reason == "PROCESS_LOST") outcome.outcome = api::AttemptOutcome::kLost;
  if (absl::IsCancelled(status)) outcome.outcome = api::AttemptOutcome::kCancelled;
  return outcome;
}

Attempt::Attempt(const AttemptSetting& setting, jobs::Lease lease)
    : setting_(setting),
      lease_(std::move(lease)),
      folder_(setting.folder / fmt::format("{}-{}", lease_.fence.job, lease_.fence.attempt)),
      drain_listener_(setting.drain, [stop = stop_]() mutable { stop.Cancel(); }),
      keeper_(KeeperConfig(setting.heartbeat_interval), setting.client, lease_, stop_),
      uploader_(setting.client, keeper_, lease_.fence) {}

void Attempt::Run() {
  base::FailPoint("worker.after_lease");
  std::error_code error;
  std::filesystem::create_directory(folder_, error);
  HandIn(Execute());
  std::filesystem::remove_all(folder_, error);
}

StatusOr<jobs::RunOutput> Attempt::Execute() {
  jobs::RunInput input;
  input.job = lease_.fence.job;
  input.attempt = lease_.fence.attempt;
  input.spec = lease_.spec;
  input.seed = lease_.seed;
  input.trace_id = lease_.trace_id;
  input.folder = folder_;
  POISE_ASSIGN_OR_RETURN(input.inputs, FetchInputs());
  input.checkpoint = FetchCheckpoint();
  if (input.checkpoint) input.checkpoint_step = lease_.checkpoint->step;

  jobs::JobContext context;
  context.run.seed = lease_.seed;
  context.run.cancellation = stop_;
  context.run.progress = [this](const base::Progress& progress) { keeper_.Report(progress); };
  context.checkpoint_interval = setting_.config.checkpoint_interval;
  context.save_checkpoint = [this](std::string_view bytes, int64_t step) {
    return uploader_.Submit(std::string(bytes), step);
  };
  POISE_RETURN_IF_ERROR(context.run.Check());

  auto child = std::make_unique<jobs::ChildProcessRunner>(ChildConfig());
  jobs::ChildProcessRunner& process = *child;
  jobs::LogRunner runner(
      std::make_unique<jobs::CountingRunner>(
          std::make_unique<jobs::DeadlineRunner>(
              std::make_unique<jobs::ManifestRunner>(std::move(child)), lease_.deadline_in),
          setting_.telemetry),
      LogInfo);
  StatusOr<jobs::RunOutput> output = runner.Run(input, context);
  usage_ = process.usage();
  return output;
}

std::optional<std::string> Attempt::FetchCheckpoint() {
  if (!lease_.checkpoint) return std::nullopt;
  const StatusOr<std::string> bytes =
      Persist([this] { return setting_.client.Download(lease_.checkpoint->artifact); },
              [this] { return stop_.cancelled(); });
  if (bytes.ok()) return *bytes;
  // The result is the same from the beginning; it only takes longer.
  if (!stop_.cancelled()) Note(bytes.status(), "checkpoint_not_found");
  return std::nullopt;
}

Status Attempt::StopOr(const Status& status) const {
  base::RunContext context;
  context.cancellation = stop_;
  POISE_RETURN_IF_ERROR(context.Check());
  return status;
}

StatusOr<std::map<std::string, std::filesystem::path>> Attempt::FetchInputs() {
  std::map<std::string, std::filesystem::path> inputs;
  const std::filesystem::path folder = folder_ / jobs::kPrivateFolder / "inputs";
  for (const std::string& artifact : jobs::ArtifactNamesIn(lease_.spec.parameters)) {
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    const std::filesystem::path path = folder / std::filesystem::path(artifact).filename();
    const Status status = Persist([&] { return setting_.client.DownloadFile(artifact, path); },
                                  [this] { return stop_.cancelled(); });
    if (!status.ok()) return StopOr(status);
    inputs[artifact] = path;
  }
  return inputs;
}

absl::Duration Attempt::StopGrace() const {
  if (keeper_.lost() || setting_.drain.stage() == DrainStage::kHurry) return absl::ZeroDuration();
  const absl::Duration grace = lease_.limits.cancel_grace;
  if (keeper_.verdict() == Verdict::kCancel) return grace;
  return std::max(grace, setting_.config.drain_grace);
}

jobs::ChildProcessConfig Attempt::ChildConfig() const {
  jobs::ChildProcessConfig config;
  const bool learns = engine::NeedsTorch(lease_.spec);
  config.program = learns ? setting_.config.learner_program : setting_.config.child_program;
  config.arguments = {learns ? "poise-learner" : "poise-worker", "--child"};
  config.environment = ChildEnvironment();
  config.stall_timeout = lease_.limits.stall_timeout;
  config.stop_grace = [this] { return StopGrace(); };
  config.on_output = [this](std::string_view line) {
    Log(level::info, "job_output",
        {{"job", lease_.fence.job}, {"attempt", lease_.fence.attempt}, {"line", line}});
  };
  return config;
}

bool Attempt::GivesUp() const {
  return keeper_.lost() || setting_.drain.stage() == DrainStage::kHurry;
}

void Attempt::HandIn(const StatusOr<jobs::RunOutput>& output) {
  const Status& status = output.status();
  keeper_.Learn(status);
  if (!keeper_.lost() && !output.ok() && setting_.drain.stage() != DrainStage::kHurry) {
    uploader_.Flush(setting_.config.flush_limit);
  }
  if (setting_.drain.stage() != DrainStage::kHurry) {
    keeper_.FlushProgress(setting_.config.flush_limit);
  }
  if (keeper_.lost()) {
    return Note(base::MakeError(absl::StatusCode::kAborted, "LEASE_LOST", "",
                                "the lease ended; the attempt's work is thrown away"),
                "lease_lost");
  }
  const bool draining = setting_.drain.stage() != DrainStage::kWork;
  if (absl::IsCancelled(status) && draining && keeper_.verdict() != Verdict::kCancel) {
    return Release();
  }
  if (!output.ok()) return Finish(FailureOutcome(status, usage_));
  StatusOr<std::vector<api::JobArtifact>> artifacts = UploadResult(*output);
  if (!artifacts.ok()) return Finish(FailureOutcome(artifacts.status(), usage_));
  Finish({.outcome = api::AttemptOutcome::kSucceeded,
          .artifacts = *std::move(artifacts),
          .usage = usage_});
}

StatusOr<std::vector<api::JobArtifact>> Attempt::UploadResult(const jobs::RunOutput& output) {
  const auto begin = std::chrono::steady_clock::now();
  const auto gives_up = [&] {
    return GivesUp() || absl::FromChrono(std::chrono::steady_clock::now() - begin) >
                            setting_.config.upload_limit;
  };
  std::vector<api::JobArtifact> artifacts;
  for (const jobs::OutputFile& file : output.files) {
    POISE_ASSIGN_OR_RETURN(
        std::string name, Persist([&] { return setting_.client.UploadFile(file.path); }, gives_up));
    std::error_code ignored;
    artifacts.push_back(
        {.name = file.name,
         .artifact = std::move(name),
         .size_bytes = static_cast<int64_t>(std::filesystem::file_size(file.path, ignored)),
         .media_type = file.media_type});
  }
  return artifacts;
}

void Attempt::Finish(jobs::Outcome outcome) {
  base::FailPoint("worker.before_finish");
  const auto tell = [&] {
    return Persist([&] { return setting_.client.Finish(lease_.fence, outcome); },
                   [this] { return GivesUp(); })
        .status();
  };
  Status status = tell();
  keeper_.Learn(status);
  const bool refused = !status.ok() && IsDefinite(status) && !keeper_.lost();
  if (refused && outcome.outcome == api::AttemptOutcome::kSucceeded) {
    // A result that the server does not take is an error, not a reason to run for ever.
    outcome = FailureOutcome(base::Annotate(status, "the result was refused"), usage_);
    status = tell();
  }
  base::FailPoint("worker.after_finish");
  if (!status.ok()) Note(status, "finish_not_taken");
}

void Attempt::Release() {
  const Status status = Persist([this] { return setting_.client.Release(lease_.fence, usage_); },
                                [this] { return GivesUp(); });
  Note(status, status.ok() ? "released" : "release_not_taken");
}

void Attempt::Note(const Status& status, const char* event) {
  base::Json fields = {
      {"job", lease_.fence.job}, {"attempt", lease_.fence.attempt}, {"trace_id", lease_.trace_id}};
  if (!status.ok()) {
    fields["reason"] = base::ErrorReason(status);
    fields["message"] = base::Message(status);
  }
  Log(status.ok() ? level::info : level::warn, event, fields);
}

}  // namespace poise::worker
