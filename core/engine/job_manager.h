#ifndef POISE_CORE_ENGINE_JOB_MANAGER_H_
#define POISE_CORE_ENGINE_JOB_MANAGER_H_

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/api/job.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/telemetry.h"
#include "core/engine/event_hub.h"
#include "core/engine/job_counters.h"
#include "core/engine/job_log.h"
#include "core/engine/job_maintenance.h"
#include "core/engine/lease_waiters.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::engine {

struct JobManagerConfig {
  std::filesystem::path data_dir;  ///< backups go below it; Engine fills it in
  jobs::JobPolicy policy;
  absl::Duration reap_interval = absl::Seconds(2);     ///< [> 0] between looks for lost workers
  absl::Duration gauge_interval = absl::Seconds(2);    ///< [> 0] between counts for the metrics
  absl::Duration collect_interval = absl::Minutes(1);  ///< [> 0] between removals of expired jobs
  absl::Duration artifact_interval = absl::Hours(1);   ///< [> 0] between removals of artifacts
  /// An artifact that no job names stays this long after it was last stored or named: an upload is
  /// there before the job that needs it.
  absl::Duration artifact_retention = absl::Hours(24);
  /// Artifacts that are kept for another reason than a job; Engine fills it in.
  std::function<std::vector<std::string>()> other_artifacts = {};
  /// Keeps what must not be lost of a job that is about to succeed; the job succeeds only after it
  /// has, and it is asked again where an answer to the worker was lost. Engine fills it in.
  std::function<Status(const api::Job&, const std::vector<api::JobArtifact>&)> before_success = {};
  JobLog* log = &JobLog::None();  ///< outlives the manager

  /// Errors: kInvalidArgument BAD_JOB_POLICY with the field.
  Status Validate() const;
};

/// On whose behalf a job is made.
struct JobCaller {
  std::string tenant = "default";
  std::string trace_id;
};

/// Jobs as server and workers use them: checks what comes in, keeps it in the store, tells those
/// who wait, and keeps the store healthy.
/// Errors of every call: those of JobStore.
/// Threads: all members may be called from any thread. Calls of the store wait for its disk.
class JobManager {
 public:
  /// `artifacts` and `telemetry` must outlive it.
  JobManager(JobManagerConfig config, std::unique_ptr<jobs::JobStore> store,
             artifacts::ArtifactStore& artifacts, base::Telemetry& telemetry);
  ~JobManager();
  JobManager(const JobManager&) = delete;
  JobManager& operator=(const JobManager&) = delete;

  // What clients ask for.

  /// Errors: those of CreateJob::Validate, FindFlow and Flow::validate; kNotFound
  /// ARTIFACT_NOT_FOUND for one that the parameters name; those of JobStore::Submit.
  StatusOr<api::Job> Create(const JobCaller& caller, const api::CreateJob& request);
  StatusOr<api::Job> Get(const std::string& tenant, const std::string& id);
  StatusOr<api::JobPage> List(const jobs::ListQuery& query);
  StatusOr<api::Job> Cancel(const std::string& tenant, const std::string& id,
                            const std::string& who);
  Status Delete(const std::string& tenant, const std::string& id);
  /// A new job from the spec and the last checkpoint of one that FAILED or was CANCELLED.
  /// Errors: kFailedPrecondition JOB_NOT_RETRYABLE; those of Create.
  StatusOr<api::Job> Retry(const JobCaller& caller, const std::string& id,
                           const std::string& request_id);
  StatusOr<std::vector<api::JobEvent>> ReadEvents(const std::string& id, int64_t after_seq,
                                                  int limit);
  /// The files of a SUCCEEDED job, or the one of that name. Errors: kFailedPrecondition
  /// JOB_NOT_SUCCEEDED; kNotFound ARTIFACT_NOT_FOUND.
  StatusOr<std::vector<api::JobArtifact>> Result(const std::string& tenant, const std::string& id,
                                                 const std::string& name);

  // What workers do.

  /// Errors: kInvalidArgument BAD_WORKER.
  Status RegisterWorker(const jobs::WorkerInfo& worker);
  StatusOr<std::optional<jobs::Lease>> Claim(const jobs::ClaimQuery& query);
  StatusOr<jobs::HeartbeatReply> Heartbeat(const jobs::Fence& fence,
                                           const std::optional<base::Progress>& progress);
  /// Errors: kNotFound ARTIFACT_NOT_FOUND, here and in Finish.
  Status CommitCheckpoint(const jobs::Fence& fence, const std::string& artifact, int64_t step);
  StatusOr<api::JobState> Finish(const jobs::Fence& fence, const jobs::Outcome& outcome);
  Status Release(const jobs::Fence& fence, const api::JobUsage& usage);
  /// The worker is known to be dead: its jobs are claimable at once. Returns how many it had.
  StatusOr<int64_t> ExpireWorker(const std::string& worker);
  /// The same for all whose id begins with `prefix`.
  StatusOr<int64_t> ExpireWorkersNamed(std::string_view prefix);

  // What operators ask for.

  StatusOr<jobs::StoreStats> Stats() { return store_->Stats(); }
  /// Errors: those of DiagnoseJobs. A fault is a finding, not an error.
  StatusOr<std::vector<jobs::Finding>> Diagnose(const base::RunContext& context);
  /// Copies the store, while it is in use, to a new file below the data folder. Returns its
  /// absolute path. Errors: those of BackUpPath and JobStore::BackUp.
  StatusOr<std::filesystem::path> BackUp(const std::string& path);
  /// Brings the gauges up to date now.
  Status ShowStats();

  const JobManagerConfig& config() const { return config_; }
  /// News of a job: events, and wishes to cancel it.
  EventHub& news() { return news_; }
  /// Its changes of state alone.
  EventHub& transitions() { return transitions_; }
  LeaseWaiters& lease_waiters() { return lease_waiters_; }

 private:
  void OnTransition(const jobs::Transition& transition);
  StatusOr<api::Job> Submit(const jobs::NewJob& job);
  Status CollectArtifacts();
  // That they are there, and stay until the job that is about to name them does.
  Status HoldArtifacts(const std::vector<std::string>& names, const std::string& field);
  std::vector<RepeatedTask> Tasks();

  const JobManagerConfig config_;
  artifacts::ArtifactStore& artifacts_;
  JobCounters counters_;
  EventHub news_;
  EventHub transitions_;
  LeaseWaiters lease_waiters_;
  JobMaintenance maintenance_;
  std::unique_ptr<jobs::JobStore> store_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_JOB_MANAGER_H_
