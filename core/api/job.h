#ifndef POISE_CORE_API_JOB_H_
#define POISE_CORE_API_JOB_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "core/base/json.h"
#include "core/base/run_context.h"
#include "core/base/status.h"

/// Jobs as callers see them; proto/poise/v1/job.proto says the same on the wire.
namespace poise::api {

enum class JobState { kQueued, kRunning, kCancelling, kSucceeded, kFailed, kCancelled };

/// "QUEUED", "RUNNING", ...
const char* JobStateName(JobState state);
/// Errors: kInvalidArgument UNKNOWN_JOB_STATE.
StatusOr<JobState> ParseJobState(std::string_view name);
/// SUCCEEDED, FAILED or CANCELLED: never changes again.
bool IsTerminal(JobState state);

/// What to do: a kind of the flow table, and its parameters as a JSON object.
struct JobSpec {
  std::string kind;
  base::Json parameters = base::Json::object();
};

/// An error that outlives the process in which it happened.
struct JobError {
  absl::StatusCode code = absl::StatusCode::kUnknown;
  std::string reason;
  std::string message;
  std::string field;

  static JobError From(const Status& status);
  Status ToStatus() const;
  bool operator==(const JobError&) const = default;
};

struct JobLimits {
  int max_errors = 3;   ///< [>= 1] attempts that may end with an error that a retry may cure
  int max_losses = 10;  ///< [>= 1] workers that may be lost without progress
  absl::Duration deadline = absl::InfiniteDuration();  ///< from creation to the end
  absl::Duration stall_timeout = absl::Seconds(120);   ///< without a change of step
  absl::Duration cancel_grace = absl::Seconds(1);      ///< between asking to stop and killing

  /// Errors: kInvalidArgument BAD_LIMIT with the field.
  Status Validate() const;
};

struct JobCheckpoint {
  std::string artifact;  ///< "artifacts/<sha256>"
  int64_t step = 0;
  int attempt = 0;
};

/// A file of a job's result.
struct JobArtifact {
  std::string name;      ///< path within the result: "variants/0001.bvh"
  std::string artifact;  ///< "artifacts/<sha256>"
  int64_t size_bytes = 0;
  std::string media_type;
  bool operator==(const JobArtifact&) const = default;
};

/// What a process used.
struct JobUsage {
  double cpu_seconds = 0;
  int64_t peak_memory_bytes = 0;
};

enum class AttemptOutcome { kRunning, kSucceeded, kError, kLost, kStalled, kReleased, kCancelled };
/// "RUNNING", "SUCCEEDED", ...
const char* AttemptOutcomeName(AttemptOutcome outcome);

struct JobAttempt {
  int attempt = 0;
  std::string worker;
  AttemptOutcome outcome = AttemptOutcome::kRunning;
  std::optional<JobError> error = {};
  absl::Time start = {};
  absl::Time end = absl::InfiniteFuture();  ///< InfiniteFuture while it runs
  JobUsage usage = {};
  int64_t from_step = 0;  ///< step of the checkpoint that it began from
  int64_t last_step = 0;
};

struct Job {
  std::string id;  ///< sorts by creation; on the wire "jobs/<id>"
  std::string tenant;
  JobState state = JobState::kQueued;
  JobSpec spec;
  std::string request_id;
  std::string queue;
  int priority = 0;
  uint64_t seed = 0;
  std::map<std::string, std::string> labels = {};
  JobLimits limits = {};

  int attempt = 0;
  int errors = 0;
  int losses = 0;
  base::Progress progress = {};
  std::optional<JobError> error = {};
  std::optional<JobCheckpoint> checkpoint = {};
  std::vector<JobArtifact> artifacts = {};
  std::vector<JobAttempt> attempts = {};  ///< oldest first; empty in lists
  int64_t event_seq = 0;

  // A time that has not come, or is not known, is InfiniteFuture.
  absl::Time create_time;
  absl::Time start_time = absl::InfiniteFuture();
  absl::Time end_time = absl::InfiniteFuture();
  absl::Time expire_time = absl::InfiniteFuture();
  absl::Time next_attempt_time = absl::InfiniteFuture();  ///< of a QUEUED job that waits to retry

  std::string retry_of;  ///< id of the job that it took over from
  std::string trace_id;
  std::string cancel_requested_by;
  std::string worker;  ///< while it runs
};

/// One entry of a job's event stream: exactly one of the three.
struct JobEvent {
  int64_t seq = 0;     ///< grows; thinned progress leaves gaps
  int64_t change = 0;  ///< counts states and checkpoints without gaps; of progress: the last one's
  absl::Time time = {};
  int attempt = 0;
  std::optional<JobState> state = {};
  std::optional<base::Progress> progress = {};
  std::optional<JobCheckpoint> checkpoint = {};
  std::optional<JobError> error = {};  ///< with a state: why
};

/// What a client asks for.
struct CreateJob {
  static constexpr size_t kMaxRequestIdLength = 128;
  static constexpr size_t kMaxParametersBytes = 256
                                                << 10;  ///< as JSON; larger input is an artifact
  static constexpr int kMaxLabels = 64;

  JobSpec spec;
  std::string request_id = {};
  std::string queue = "default";
  int priority = 0;
  uint64_t seed = 0;
  std::map<std::string, std::string> labels = {};
  JobLimits limits = {};

  /// Errors: kInvalidArgument BAD_REQUEST_ID, BAD_QUEUE, BAD_PRIORITY (outside -10 to 10),
  /// TOO_MANY_LABELS, BAD_LABEL, TOO_LARGE, BAD_LIMIT.
  Status Validate() const;
};

/// Which jobs a list holds; empty fields match all.
struct JobFilter {
  std::optional<JobState> state = {};
  std::string kind = {};
  std::string queue = {};
  std::map<std::string, std::string> labels = {};

  /// "state=FAILED kind=selftest queue=default label.run=7". Errors: kInvalidArgument BAD_FILTER.
  static StatusOr<JobFilter> Parse(std::string_view text);
  /// The same for equal filters.
  std::string ToString() const;
};

struct JobPage {
  std::vector<Job> jobs;
  std::string next_page_token;  ///< empty at the end
};

}  // namespace poise::api

#endif  // POISE_CORE_API_JOB_H_
