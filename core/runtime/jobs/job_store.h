#ifndef POISE_CORE_RUNTIME_JOBS_JOB_STORE_H_
#define POISE_CORE_RUNTIME_JOBS_JOB_STORE_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/base/status.h"

namespace poise::jobs {

/// Rules that hold for all jobs of a store.
struct JobPolicy {
  absl::Duration lease = absl::Seconds(30);               ///< [> 0] a worker not heard of is lost
  absl::Duration heartbeat_interval = absl::Seconds(10);  ///< [> 0, < lease] told to workers
  absl::Duration first_backoff = absl::Seconds(5);        ///< doubled for each error more
  absl::Duration max_backoff = absl::Minutes(10);         ///< delays are drawn from (0, this]
  absl::Duration retention = 30 * absl::Hours(24);        ///< of terminal jobs and their results
  absl::Duration event_retention = 7 * absl::Hours(24);   ///< after the end of the job
  absl::Duration progress_interval = absl::Seconds(1);    ///< at most one progress event per this
  int max_progress_events = 1000;  ///< [> 1] per job; beyond it every second one is dropped
  int64_t max_queued_per_tenant = 10'000;
  int64_t max_running_per_tenant = 1'000'000;
  int64_t max_unfinished = 1'000'000;  ///< queued and running jobs of the whole store
  std::map<std::string, double> tenant_weights = {};  ///< share of running jobs; default 1
  absl::Duration age_step = absl::Minutes(10);  ///< waiting this long lifts a job one priority
  absl::Duration quota_retry_delay = absl::Seconds(5);  ///< told with QUOTA_EXCEEDED
};

/// A job on its way into the store: checked, with its digest.
struct NewJob {
  std::string tenant = "default";
  api::CreateJob request = {};
  std::string content_digest = {};  ///< of everything in the request but its id
  std::string trace_id = {};
  std::string retry_of = {};                          ///< id, with RetryJob
  std::optional<api::JobCheckpoint> checkpoint = {};  ///< taken over from that job
};

struct SubmitOutcome {
  api::Job job;
  bool created = false;  ///< false: the request id was known
};

struct ListQuery {
  std::string tenant = "default";
  api::JobFilter filter = {};
  int page_size = 0;  ///< 0: 50; above 1000: 1000
  std::string page_token = {};
};

/// Who writes for a job. `token` was made by the worker for its Claim call.
struct Fence {
  std::string job;  ///< id
  int attempt = 0;
  std::string token;
};

struct ClaimQuery {
  std::string worker;
  std::string token;
  std::vector<std::string> queues = {};  ///< empty: all
  std::vector<std::string> kinds = {};   ///< empty: all
};

struct Lease {
  Fence fence;
  absl::Duration expires_in;
  api::JobSpec spec;
  uint64_t seed = 0;
  api::JobLimits limits;
  std::optional<api::JobCheckpoint> checkpoint = {};
  std::string trace_id;
  absl::Duration deadline_in = absl::InfiniteDuration();
};

enum class Directive { kContinue, kCancel };

struct HeartbeatReply {
  Directive directive = Directive::kContinue;
  absl::Duration expires_in;
};

/// How an attempt ended.
struct Outcome {
  /// kSucceeded, kError, kStalled, kLost (its process vanished) or kCancelled.
  api::AttemptOutcome outcome = api::AttemptOutcome::kSucceeded;
  std::optional<api::JobError> error = {};       ///< with kError, kStalled, kLost
  std::vector<api::JobArtifact> artifacts = {};  ///< with kSucceeded
  api::JobUsage usage = {};
};

struct WorkerInfo {
  std::string id;
  std::string host = {};
  std::string engine = {};  ///< local, kubernetes, slurm, manual
  std::string engine_ref = {};
  std::string version = {};
  int slots = 1;
  absl::Time last_seen = {};
};

/// A change of state, for the log, the counters and those who watch.
struct Transition {
  std::string job, tenant, kind, trace_id, worker;
  int attempt = 0;
  std::optional<api::JobState> from;  ///< nullopt: created
  api::JobState to{};
  std::optional<api::JobError> error;
  absl::Duration in_state;                                ///< how long it was in `from`
  absl::Time next_attempt_time = absl::InfiniteFuture();  ///< with kQueued, when it has to wait
};

struct StoreStats {
  /// Per tenant and per state, all states present.
  std::map<std::string, std::map<api::JobState, int64_t>> jobs;
  int64_t leases = 0;
  int64_t events = 0;
  int64_t submitted = 0;  ///< jobs ever created, deleted ones too
  int64_t deleted = 0;
  absl::Duration oldest_queued;  ///< age of the job that waits longest and could run
  int64_t file_bytes = 0;
  int64_t wal_bytes = 0;
};

struct Finding {
  enum class Severity { kOk, kWarning, kFault };
  Severity severity;
  std::string check;
  std::string message;
};

/// Where jobs live. Every call is one short transaction; when it returns OK, what it did survives
/// power loss. reference for states and guards: docs/reliability.md.
/// Errors of every call: kUnavailable STORE_UNAVAILABLE with a retry time; kDataLoss STORE_CORRUPT.
/// Threads: all members may be called from any thread.
class JobStore {
 public:
  /// Called after the commit of each change of state, in the order of commits, and with the id of
  /// a job that has new events or a wish to cancel. Must be quick and must not call the store.
  struct Listener {
    std::function<void(const Transition&)> on_transition;
    std::function<void(const std::string& job)> on_event;
  };

  virtual ~JobStore() = default;

  /// To be called once, before anything else.
  virtual void SetListener(Listener listener) = 0;

  /// Errors: kInvalidArgument REQUEST_ID_REUSED (known with another digest); kResourceExhausted
  /// QUOTA_EXCEEDED (the tenant's), kUnavailable STORE_FULL, both with a retry time.
  virtual StatusOr<SubmitOutcome> Submit(const NewJob& job) = 0;

  /// With attempts and artifacts. Errors, here and below: kNotFound JOB_NOT_FOUND.
  virtual StatusOr<api::Job> Get(const std::string& tenant, const std::string& id) = 0;

  /// Newest first. Errors: kInvalidArgument BAD_PAGE_SIZE (negative), BAD_PAGE_TOKEN (not ours, or
  /// of another filter).
  virtual StatusOr<api::JobPage> List(const ListQuery& query) = 0;

  /// Of a terminal job: as it is.
  virtual StatusOr<api::Job> RequestCancel(const std::string& tenant, const std::string& id,
                                           const std::string& who) = 0;

  /// Errors: kFailedPrecondition JOB_NOT_TERMINAL.
  virtual Status Delete(const std::string& tenant, const std::string& id) = 0;

  /// At most `limit` events after `after_seq`, in order. Of several progress events with no other
  /// event between them only the last is given. JobEvent::change has no gaps, so a reader sees that
  /// no state and no checkpoint is missing; once event_retention is over, only the terminal event
  /// is left.
  virtual StatusOr<std::vector<api::JobEvent>> ReadEvents(const std::string& id, int64_t after_seq,
                                                          int limit) = 0;

  // What workers do. A fence that does not fit: kAborted LEASE_LOST.

  virtual Status UpsertWorker(const WorkerInfo& worker) = 0;

  /// The next job for this worker: of the tenant with the fewest running jobs for its weight (of
  /// several that have equally few, they take turns by weight), then by priority, age and id.
  /// nullopt when there is none. The same token again gives the same lease, as its answer may have
  /// been lost, and takes it further, but only a few times. Errors: kFailedPrecondition
  /// UNKNOWN_WORKER (register first).
  virtual StatusOr<std::optional<Lease>> Claim(const ClaimQuery& query) = 0;

  /// Takes the lease further. The progress may be empty.
  virtual StatusOr<HeartbeatReply> Heartbeat(const Fence& fence,
                                             const std::optional<base::Progress>& progress) = 0;

  /// The job of a live lease, without taking the lease further.
  virtual StatusOr<api::Job> Leased(const Fence& fence) = 0;

  /// Idempotent. A greater step than the last checkpoint's sets the losses to 0.
  virtual Status CommitCheckpoint(const Fence& fence, const std::string& artifact,
                                  int64_t step) = 0;

  /// Ends the attempt, and the job unless it is tried again. A wish to cancel wins over everything
  /// but success. Idempotent for the same fence and outcome. Errors: kInvalidArgument BAD_OUTCOME.
  virtual StatusOr<api::JobState> Finish(const Fence& fence, const Outcome& outcome) = 0;

  /// Gives the job back, free of charge; it is claimable at once (or CANCELLED, if that was
  /// wished).
  virtual Status Release(const Fence& fence, const api::JobUsage& usage) = 0;

  // What keeps the store healthy; any process may do it at any time.

  /// Ends attempts whose lease has expired, and jobs past their deadline. Returns how many.
  virtual StatusOr<int64_t> Reap() = 0;

  /// The worker is known to be dead: its leases end now, as if they had expired.
  virtual StatusOr<int64_t> ExpireWorker(const std::string& worker) = 0;

  /// Removes terminal jobs past their time, and old events. Returns how many jobs.
  virtual StatusOr<int64_t> CollectExpired() = 0;

  /// Every artifact that a job, its checkpoint or its parameters need.
  virtual StatusOr<std::vector<std::string>> ReferencedArtifacts() = 0;

  virtual StatusOr<StoreStats> Stats() = 0;
  virtual StatusOr<std::vector<WorkerInfo>> Workers() = 0;
  virtual StatusOr<std::vector<Finding>> Diagnose() = 0;
  /// Errors: kFailedPrecondition FILE_EXISTS, CANNOT_WRITE.
  virtual Status BackUp(const std::filesystem::path& path) = 0;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_JOB_STORE_H_
