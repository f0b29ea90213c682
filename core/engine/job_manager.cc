#include "core/engine/job_manager.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/fail_point.h"
#include "core/base/sha256.h"
#include "core/engine/backup_path.h"
#include "core/engine/flow_table.h"
#include "core/engine/job_diagnosis.h"
#include "core/runtime/jobs/job_json.h"

namespace poise::engine {
namespace {

constexpr size_t kMaxWorkerName = 200;

Status CheckPositive(absl::Duration value, const char* field) {
  if (value > absl::ZeroDuration()) return absl::OkStatus();
  return base::InvalidArgument(
      "BAD_JOB_POLICY", field,
      fmt::format("{} is {}, expected more than 0", field, absl::FormatDuration(value)));
}

// Everything in the request but its id; the same for the same wish, however it was written.
std::string ContentDigest(const api::CreateJob& request, const std::string& retry_of) {
  // Unlike base::Json this one sorts its keys.
  const nlohmann::json content = {{"kind", request.spec.kind},
                                  {"parameters", nlohmann::json(request.spec.parameters)},
                                  {"queue", request.queue},
                                  {"priority", request.priority},
                                  {"seed", request.seed},
                                  {"labels", request.labels},
                                  {"limits", jobs::ToJson(request.limits)},
                                  {"retry_of", retry_of}};
  return base::Sha256Hex(content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

api::CreateJob RequestOf(const api::Job& job, const std::string& request_id) {
  return {.spec = job.spec,
          .request_id = request_id,
          .queue = job.queue,
          .priority = job.priority,
          .seed = job.seed,
          .labels = job.labels,
          .limits = job.limits};
}

}  // namespace

Status JobManagerConfig::Validate() const {
  POISE_RETURN_IF_ERROR(CheckPositive(policy.lease, "lease"));
  POISE_RETURN_IF_ERROR(CheckPositive(policy.heartbeat_interval, "heartbeat_interval"));
  POISE_RETURN_IF_ERROR(CheckPositive(policy.first_backoff, "first_backoff"));
  POISE_RETURN_IF_ERROR(CheckPositive(policy.retention, "retention"));
  POISE_RETURN_IF_ERROR(CheckPositive(reap_interval, "reap_interval"));
  if (policy.heartbeat_interval >= policy.lease) {
    return base::InvalidArgument("BAD_JOB_POLICY", "heartbeat_interval",
                                 "heartbeat_interval must be shorter than the lease");
  }
  if (policy.max_backoff < policy.first_backoff) {
    return base::InvalidArgument("BAD_JOB_POLICY", "max_backoff",
                                 "max_backoff must not be shorter than first_backoff");
  }
  return absl::OkStatus();
}

JobManager::JobManager(JobManagerConfig config, std::unique_ptr<jobs::JobStore> store,
                       artifacts::ArtifactStore& artifacts, base::Telemetry& telemetry)
    : config_(std::move(config)),
      artifacts_(artifacts),
      counters_(telemetry),
      maintenance_(*config_.log),
      store_(std::move(store)) {
  store_->SetListener(
      {.on_transition = [this](const auto& transition) { OnTransition(transition); },
       .on_event = [this](const std::string& job) { news_.Publish(job); }});
  maintenance_.Start(Tasks());
}

JobManager::~JobManager() { maintenance_.Stop(); }

StatusOr<api::Job> JobManager::Create(const JobCaller& caller, const api::CreateJob& request) {
  POISE_RETURN_IF_ERROR(request.Validate());
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(request.spec.kind));
  POISE_RETURN_IF_ERROR(flow->validate(request.spec.parameters));
  POISE_RETURN_IF_ERROR(
      HoldArtifacts(jobs::ArtifactNamesIn(request.spec.parameters), "spec.parameters"));
  return Submit({.tenant = caller.tenant,
                 .request = request,
                 .content_digest = ContentDigest(request, ""),
                 .trace_id = caller.trace_id});
}

StatusOr<api::Job> JobManager::Retry(const JobCaller& caller, const std::string& id,
                                     const std::string& request_id) {
  POISE_ASSIGN_OR_RETURN(const api::Job job, store_->Get(caller.tenant, id));
  if (job.state != api::JobState::kFailed && job.state != api::JobState::kCancelled) {
    return base::FailedPrecondition("JOB_NOT_RETRYABLE", "name",
                                    fmt::format("job '{}' is {}, expected FAILED or CANCELLED", id,
                                                api::JobStateName(job.state)));
  }
  const api::CreateJob request = RequestOf(job, request_id);
  POISE_RETURN_IF_ERROR(request.Validate());
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(request.spec.kind));
  POISE_RETURN_IF_ERROR(flow->validate(request.spec.parameters));
  // That job may be deleted meanwhile.
  std::vector<std::string> artifacts = jobs::ArtifactNamesIn(request.spec.parameters);
  if (job.checkpoint) artifacts.push_back(job.checkpoint->artifact);
  POISE_RETURN_IF_ERROR(HoldArtifacts(artifacts, "name"));
  return Submit({.tenant = caller.tenant,
                 .request = request,
                 .content_digest = ContentDigest(request, id),
                 .trace_id = caller.trace_id,
                 .retry_of = id,
                 .checkpoint = job.checkpoint});
}

StatusOr<api::Job> JobManager::Submit(const jobs::NewJob& job) {
  POISE_ASSIGN_OR_RETURN(jobs::SubmitOutcome outcome, store_->Submit(job));
  base::FailPoint("jobs.after_submit");  // committed, not answered
  return std::move(outcome.job);
}

StatusOr<api::Job> JobManager::Get(const std::string& tenant, const std::string& id) {
  return store_->Get(tenant, id);
}

StatusOr<api::JobPage> JobManager::List(const jobs::ListQuery& query) {
  return store_->List(query);
}

StatusOr<api::Job> JobManager::Cancel(const std::string& tenant, const std::string& id,
                                      const std::string& who) {
  return store_->RequestCancel(tenant, id, who);
}

Status JobManager::Delete(const std::string& tenant, const std::string& id) {
  POISE_RETURN_IF_ERROR(store_->Delete(tenant, id));
  counters_.CountDeleted(1);
  news_.Publish(id);
  return absl::OkStatus();
}

StatusOr<std::vector<api::JobEvent>> JobManager::ReadEvents(const std::string& id,
                                                            int64_t after_seq, int limit) {
  return store_->ReadEvents(id, after_seq, limit);
}

StatusOr<std::vector<api::JobArtifact>> JobManager::Result(const std::string& tenant,
                                                           const std::string& id,
                                                           const std::string& name) {
  POISE_ASSIGN_OR_RETURN(api::Job job, store_->Get(tenant, id));
  if (job.state != api::JobState::kSucceeded) {
    return base::FailedPrecondition(
        "JOB_NOT_SUCCEEDED", "name",
        fmt::format("job '{}' is {} and has no result", id, api::JobStateName(job.state)));
  }
  if (name.empty()) return std::move(job.artifacts);
  for (const api::JobArtifact& artifact : job.artifacts) {
    if (artifact.name == name) return std::vector{artifact};
  }
  return base::NotFound("ARTIFACT_NOT_FOUND", "artifact",
                        fmt::format("the result of job '{}' has no '{}'", id, name));
}

Status JobManager::RegisterWorker(const jobs::WorkerInfo& worker) {
  if (worker.id.empty() || worker.id.size() > kMaxWorkerName) {
    return base::InvalidArgument(
        "BAD_WORKER", "worker",
        fmt::format("the worker's name has {} characters, expected 1 to {}", worker.id.size(),
                    kMaxWorkerName));
  }
  if (worker.slots < 1) {
    return base::InvalidArgument("BAD_WORKER", "slots",
                                 fmt::format("slots is {}, expected 1 or more", worker.slots));
  }
  return store_->UpsertWorker(worker);
}

StatusOr<std::optional<jobs::Lease>> JobManager::Claim(const jobs::ClaimQuery& query) {
  return store_->Claim(query);
}

StatusOr<jobs::HeartbeatReply> JobManager::Heartbeat(
    const jobs::Fence& fence, const std::optional<base::Progress>& progress) {
  return store_->Heartbeat(fence, progress);
}

Status JobManager::CommitCheckpoint(const jobs::Fence& fence, const std::string& artifact,
                                    int64_t step) {
  POISE_RETURN_IF_ERROR(HoldArtifacts({artifact}, "artifact"));
  return store_->CommitCheckpoint(fence, artifact, step);
}

StatusOr<api::JobState> JobManager::Finish(const jobs::Fence& fence, const jobs::Outcome& outcome) {
  std::vector<std::string> names;
  for (const api::JobArtifact& artifact : outcome.artifacts) names.push_back(artifact.artifact);
  POISE_RETURN_IF_ERROR(HoldArtifacts(names, "artifacts"));
  if (config_.before_success && outcome.outcome == api::AttemptOutcome::kSucceeded) {
    // Without a lease the store answers, also what it answered before.
    const StatusOr<api::Job> job = store_->Leased(fence);
    if (job.ok()) POISE_RETURN_IF_ERROR(config_.before_success(*job, outcome.artifacts));
  }
  return store_->Finish(fence, outcome);
}

Status JobManager::Release(const jobs::Fence& fence, const api::JobUsage& usage) {
  return store_->Release(fence, usage);
}

StatusOr<int64_t> JobManager::ExpireWorker(const std::string& worker) {
  return store_->ExpireWorker(worker);
}

StatusOr<int64_t> JobManager::ExpireWorkersNamed(std::string_view prefix) {
  POISE_ASSIGN_OR_RETURN(const std::vector<jobs::WorkerInfo> workers, store_->Workers());
  int64_t expired = 0;
  for (const jobs::WorkerInfo& worker : workers) {
    if (!worker.id.starts_with(prefix)) continue;
    POISE_ASSIGN_OR_RETURN(const int64_t leases, store_->ExpireWorker(worker.id));
    expired += leases;
  }
  return expired;
}

StatusOr<std::vector<jobs::Finding>> JobManager::Diagnose(const base::RunContext& context) {
  return DiagnoseJobs(*store_, artifacts_, context);
}

StatusOr<std::filesystem::path> JobManager::BackUp(const std::string& path) {
  POISE_ASSIGN_OR_RETURN(std::filesystem::path full, BackUpPath(config_.data_dir, path));
  POISE_RETURN_IF_ERROR(store_->BackUp(full));
  return full;
}

Status JobManager::ShowStats() {
  POISE_ASSIGN_OR_RETURN(const jobs::StoreStats stats, store_->Stats());
  POISE_ASSIGN_OR_RETURN(const auto workers, store_->Workers());
  const absl::Time alive = absl::Now() - config_.policy.lease;
  counters_.Show(stats, std::count_if(workers.begin(), workers.end(), [&](const auto& worker) {
                   return worker.last_seen >= alive;
                 }));
  return absl::OkStatus();
}

void JobManager::OnTransition(const jobs::Transition& transition) {
  counters_.Count(transition);
  config_.log->OnTransition(transition);
  transitions_.Publish(transition.job);
  if (transition.to != api::JobState::kQueued) {
    // An attempt that ended makes room under the tenant's limit of running jobs.
    if (api::IsTerminal(transition.to)) lease_waiters_.AnyJobReady();
  } else if (transition.next_attempt_time == absl::InfiniteFuture()) {
    lease_waiters_.JobReady(transition.kind);
  } else {
    maintenance_.RunAt(transition.next_attempt_time,
                       [this, kind = transition.kind] { lease_waiters_.JobReady(kind); });
  }
}

Status JobManager::HoldArtifacts(const std::vector<std::string>& names, const std::string& field) {
  for (const std::string& name : names) {
    const Status status = artifacts_.Refresh(name).status();
    if (!status.ok()) {
      return base::MakeError(status.code(), base::ErrorReason(status), field,
                             base::Message(status));
    }
  }
  return absl::OkStatus();
}

Status JobManager::CollectArtifacts() {
  // Before the look at the jobs: what is named after it was refreshed after this, too.
  const absl::Time limit = absl::Now() - config_.artifact_retention;
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> names, store_->ReferencedArtifacts());
  std::set<std::string> keep(names.begin(), names.end());
  if (config_.other_artifacts) {
    for (std::string& name : config_.other_artifacts()) keep.insert(std::move(name));
  }
  artifacts_.Collect(keep, limit);
  artifacts_.CollectUploads(absl::Now());
  return absl::OkStatus();
}

std::vector<RepeatedTask> JobManager::Tasks() {
  // While no server was there, no worker could be heard of: they get the time to come back.
  const absl::Duration comeback = config_.policy.heartbeat_interval;
  return {{"reap", config_.reap_interval, [this] { return store_->Reap().status(); }, comeback},
          {"wake", config_.reap_interval,
           [this] {
             // Finds what no transition tells of: retries that an earlier process was told of.
             lease_waiters_.AnyJobReady();
             return absl::OkStatus();
           }},
          {"collect", config_.collect_interval,
           [this] {
             POISE_ASSIGN_OR_RETURN(const int64_t jobs, store_->CollectExpired());
             counters_.CountDeleted(jobs);
             return absl::OkStatus();
           }},
          {"collect artifacts", config_.artifact_interval, [this] { return CollectArtifacts(); }},
          {"stats", config_.gauge_interval, [this] { return ShowStats(); }}};
}

}  // namespace poise::engine
