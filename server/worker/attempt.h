#ifndef POISE_SERVER_WORKER_ATTEMPT_H_
#define POISE_SERVER_WORKER_ATTEMPT_H_

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/telemetry.h"
#include "core/runtime/jobs/child_process_runner.h"
#include "core/runtime/jobs/job_runner.h"
#include "server/worker/checkpoint_uploader.h"
#include "server/worker/drain_signal.h"
#include "server/worker/lease_keeper.h"
#include "server/worker/worker_client.h"
#include "server/worker/worker_config.h"

namespace poise::worker {

/// What all attempts of a worker share; all of it outlives them.
struct AttemptSetting {
  const WorkerConfig& config;
  const std::filesystem::path& folder;
  absl::Duration heartbeat_interval;
  WorkerClient& client;
  DrainSignal& drain;
  base::Telemetry& telemetry;
};

/// One lease from beginning to end: fetches the checkpoint, runs the job in a child process, hands
/// in what came of it. When the lease is lost it kills the child and throws its work away; when the
/// worker goes away it gives the job back.
class Attempt {
 public:
  Attempt(const AttemptSetting& setting, jobs::Lease lease);
  /// On a thread that lives as long as the attempt: the child dies with it.
  void Run();

 private:
  StatusOr<jobs::RunOutput> Execute();
  std::optional<std::string> FetchCheckpoint();
  StatusOr<std::map<std::string, std::filesystem::path>> FetchInputs();
  // The wish to stop, if there is one: it explains what failed.
  Status StopOr(const Status& status) const;
  absl::Duration StopGrace() const;
  jobs::ChildProcessConfig ChildConfig() const;
  void HandIn(const StatusOr<jobs::RunOutput>& output);
  StatusOr<std::vector<api::JobArtifact>> UploadResult(const jobs::RunOutput& output);
  void Finish(jobs::Outcome outcome);
  void Release();
  // What was said about the attempt's end, once.
  void Note(const Status& status, const char* event);
  bool GivesUp() const;

  const AttemptSetting setting_;
  const jobs::Lease lease_;
  const std::filesystem::path folder_;
  base::CancellationToken stop_;
  DrainSignal::Listener drain_listener_;
  LeaseKeeper keeper_;
  CheckpointUploader uploader_;
  api::JobUsage usage_;
};

/// What an attempt that did not succeed tells the server.
jobs::Outcome FailureOutcome(const Status& status, const api::JobUsage& usage);

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_ATTEMPT_H_
