#include "proto/convert/job_convert.h"

#include <fmt/format.h>

#include <utility>

#include "proto/convert/struct_convert.h"
#include "proto/convert/time_convert.h"
#include "proto/convert/utf8.h"

namespace poise::convert {
namespace {

constexpr std::string_view kJobPrefix = "jobs/";

void SetTime(absl::Time time, google::protobuf::Timestamp* (v1::Job::*field)(), v1::Job& message) {
  if (time != absl::InfiniteFuture()) *(message.*field)() = ToProto(time);
}

absl::Time TimeOrNever(bool present, const google::protobuf::Timestamp& time) {
  return present ? FromProto(time) : absl::InfiniteFuture();
}

v1::JobAttempt AttemptToProto(const api::JobAttempt& attempt) {
  v1::JobAttempt message;
  message.set_attempt(attempt.attempt);
  message.set_worker(ValidUtf8(attempt.worker));
  message.set_outcome(ToProto(attempt.outcome));
  if (attempt.error) *message.mutable_error() = ToProto(*attempt.error);
  *message.mutable_start_time() = ToProto(attempt.start);
  if (attempt.end != absl::InfiniteFuture()) *message.mutable_end_time() = ToProto(attempt.end);
  message.set_cpu_seconds(attempt.usage.cpu_seconds);
  message.set_peak_memory_bytes(attempt.usage.peak_memory_bytes);
  message.set_from_step(attempt.from_step);
  message.set_last_step(attempt.last_step);
  return message;
}

StatusOr<api::JobAttempt> AttemptFromProto(const v1::JobAttempt& message) {
  api::JobAttempt attempt;
  attempt.attempt = message.attempt();
  attempt.worker = message.worker();
  POISE_ASSIGN_OR_RETURN(attempt.outcome, FromProto(message.outcome()));
  if (message.has_error()) attempt.error = FromProto(message.error());
  attempt.start = FromProto(message.start_time());
  attempt.end = TimeOrNever(message.has_end_time(), message.end_time());
  attempt.usage = {.cpu_seconds = message.cpu_seconds(),
                   .peak_memory_bytes = message.peak_memory_bytes()};
  attempt.from_step = message.from_step();
  attempt.last_step = message.last_step();
  return attempt;
}

}  // namespace

std::string JobName(std::string_view id) { return std::string(kJobPrefix) + std::string(id); }

StatusOr<std::string> JobId(std::string_view name) {
  if (name.starts_with(kJobPrefix) && name.size() > kJobPrefix.size()) {
    return std::string(name.substr(kJobPrefix.size()));
  }
  return base::InvalidArgument("BAD_JOB_NAME", "name",
                               fmt::format("'{}': expected jobs/<id>", ValidUtf8(name)));
}

v1::Job::State ToProto(api::JobState state) {
  switch (state) {
    case api::JobState::kQueued:
      return v1::Job::QUEUED;
    case api::JobState::kRunning:
      return v1::Job::RUNNING;
    case api::JobState::kCancelling:
      return v1::Job::CANCELLING;
    case api::JobState::kSucceeded:
      return v1::Job::SUCCEEDED;
    case api::JobState::kFailed:
      return v1::Job::FAILED;
    case api::JobState::kCancelled:
      return v1::Job::CANCELLED;
  }
  return v1::Job::STATE_UNSPECIFIED;
}

StatusOr<api::JobState> FromProto(v1::Job::State state) {
  switch (state) {
    case v1::Job::QUEUED:
      return api::JobState::kQueued;
    case v1::Job::RUNNING:
      return api::JobState::kRunning;
    case v1::Job::CANCELLING:
      return api::JobState::kCancelling;
    case v1::Job::SUCCEEDED:
      return api::JobState::kSucceeded;
    case v1::Job::FAILED:
      return api::JobState::kFailed;
    case v1::Job::CANCELLED:
      return api::JobState::kCancelled;
    default:
      return base::InvalidArgument(
          "UNKNOWN_JOB_STATE", "state",
          fmt::format("state {} of a job is not known here", static_cast<int>(state)));
  }
}

v1::JobAttempt::Outcome ToProto(api::AttemptOutcome outcome) {
  switch (outcome) {
    case api::AttemptOutcome::kRunning:
      return v1::JobAttempt::RUNNING;
    case api::AttemptOutcome::kSucceeded:
      return v1::JobAttempt::SUCCEEDED;
    case api::AttemptOutcome::kError:
      return v1::JobAttempt::ERROR;
    case api::AttemptOutcome::kLost:
      return v1::JobAttempt::LOST;
    case api::AttemptOutcome::kStalled:
      return v1::JobAttempt::STALLED;
    case api::AttemptOutcome::kReleased:
      return v1::JobAttempt::RELEASED;
    case api::AttemptOutcome::kCancelled:
      return v1::JobAttempt::CANCELLED;
  }
  return v1::JobAttempt::OUTCOME_UNSPECIFIED;
}

StatusOr<api::AttemptOutcome> FromProto(v1::JobAttempt::Outcome outcome) {
  switch (outcome) {
    case v1::JobAttempt::RUNNING:
      return api::AttemptOutcome::kRunning;
    case v1::JobAttempt::SUCCEEDED:
      return api::AttemptOutcome::kSucceeded;
    case v1::JobAttempt::ERROR:
      return api::AttemptOutcome::kError;
    case v1::JobAttempt::LOST:
      return api::AttemptOutcome::kLost;
    case v1::JobAttempt::STALLED:
      return api::AttemptOutcome::kStalled;
    case v1::JobAttempt::RELEASED:
      return api::AttemptOutcome::kReleased;
    case v1::JobAttempt::CANCELLED:
      return api::AttemptOutcome::kCancelled;
    default:
      return base::InvalidArgument(
          "UNKNOWN_OUTCOME", "outcome",
          fmt::format("outcome {} of an attempt is not known here", static_cast<int>(outcome)));
  }
}

v1::JobSpec ToProto(const api::JobSpec& spec) {
  v1::JobSpec message;
  message.set_kind(ValidUtf8(spec.kind));
  *message.mutable_parameters() = ToProto(spec.parameters);
  return message;
}

StatusOr<api::JobSpec> FromProto(const v1::JobSpec& message) {
  api::JobSpec spec;
  spec.kind = message.kind();
  POISE_ASSIGN_OR_RETURN(spec.parameters, FromProto(message.parameters(), "spec.parameters"));
  return spec;
}

v1::JobError ToProto(const api::JobError& error) {
  v1::JobError message;
  message.set_code(static_cast<int>(error.code));
  message.set_reason(ValidUtf8(error.reason));
  message.set_message(ValidUtf8(error.message));
  message.set_field(ValidUtf8(error.field));
  return message;
}

api::JobError FromProto(const v1::JobError& message) {
  return {.code = static_cast<absl::StatusCode>(message.code()),
          .reason = message.reason(),
          .message = message.message(),
          .field = message.field()};
}

v1::JobLimits ToProto(const api::JobLimits& limits) {
  v1::JobLimits message;
  message.set_max_errors(limits.max_errors);
  message.set_max_losses(limits.max_losses);
  if (limits.deadline != absl::InfiniteDuration()) {
    *message.mutable_deadline() = ToProto(limits.deadline);
  }
  *message.mutable_stall_timeout() = ToProto(limits.stall_timeout);
  *message.mutable_cancel_grace() = ToProto(limits.cancel_grace);
  return message;
}

StatusOr<api::JobLimits> FromProto(const v1::JobLimits& message) {
  api::JobLimits limits;
  if (message.max_errors() != 0) limits.max_errors = message.max_errors();
  if (message.max_losses() != 0) limits.max_losses = message.max_losses();
  const auto set = [](const google::protobuf::Duration& duration, absl::Duration& value) {
    if (duration.seconds() != 0 || duration.nanos() != 0) value = FromProto(duration);
  };
  set(message.deadline(), limits.deadline);
  set(message.stall_timeout(), limits.stall_timeout);
  set(message.cancel_grace(), limits.cancel_grace);
  POISE_RETURN_IF_ERROR(limits.Validate());
  return limits;
}

v1::JobProgress ToProto(const base::Progress& progress) {
  v1::JobProgress message;
  message.set_step(progress.step);
  message.set_total(progress.total);
  message.set_message(ValidUtf8(progress.message));
  for (const auto& [name, value] : progress.metrics) {
    (*message.mutable_metrics())[ValidUtf8(name)] = value;
  }
  return message;
}

base::Progress FromProto(const v1::JobProgress& message) {
  return {.step = message.step(),
          .total = message.total(),
          .message = message.message(),
          .metrics = {message.metrics().begin(), message.metrics().end()}};
}

v1::JobCheckpoint ToProto(const api::JobCheckpoint& checkpoint) {
  v1::JobCheckpoint message;
  message.set_artifact(checkpoint.artifact);
  message.set_step(checkpoint.step);
  message.set_attempt(checkpoint.attempt);
  return message;
}

api::JobCheckpoint FromProto(const v1::JobCheckpoint& message) {
  return {.artifact = message.artifact(), .step = message.step(), .attempt = message.attempt()};
}

v1::JobArtifact ToProto(const api::JobArtifact& artifact) {
  v1::JobArtifact message;
  message.set_name(ValidUtf8(artifact.name));
  message.set_artifact(artifact.artifact);
  message.set_size_bytes(artifact.size_bytes);
  message.set_media_type(ValidUtf8(artifact.media_type));
  return message;
}

api::JobArtifact FromProto(const v1::JobArtifact& message) {
  return {.name = message.name(),
          .artifact = message.artifact(),
          .size_bytes = message.size_bytes(),
          .media_type = message.media_type()};
}

v1::JobEvent ToProto(const api::JobEvent& event) {
  v1::JobEvent message;
  message.set_seq(event.seq);
  message.set_change(event.change);
  *message.mutable_time() = ToProto(event.time);
  message.set_attempt(event.attempt);
  if (event.state) {
    message.set_state(ToProto(*event.state));
  } else if (event.progress) {
    *message.mutable_progress() = ToProto(*event.progress);
  } else if (event.checkpoint) {
    *message.mutable_checkpoint() = ToProto(*event.checkpoint);
  }
  if (event.error) *message.mutable_error() = ToProto(*event.error);
  return message;
}

StatusOr<api::JobEvent> FromProto(const v1::JobEvent& message) {
  api::JobEvent event;
  event.seq = message.seq();
  event.change = message.change();
  event.time = FromProto(message.time());
  event.attempt = message.attempt();
  if (message.has_state()) {
    POISE_ASSIGN_OR_RETURN(event.state, FromProto(message.state()));
  }
  if (message.has_progress()) event.progress = FromProto(message.progress());
  if (message.has_checkpoint()) event.checkpoint = FromProto(message.checkpoint());
  if (message.has_error()) event.error = FromProto(message.error());
  return event;
}

v1::Job ToProto(const api::Job& job) {
  v1::Job message;
  message.set_name(JobName(job.id));
  message.set_state(ToProto(job.state));
  *message.mutable_spec() = ToProto(job.spec);
  message.set_request_id(job.request_id);
  message.set_queue(job.queue);
  message.set_priority(job.priority);
  message.set_seed(job.seed);
  message.mutable_labels()->insert(job.labels.begin(), job.labels.end());
  *message.mutable_limits() = ToProto(job.limits);
  message.set_attempt(job.attempt);
  message.set_errors(job.errors);
  message.set_losses(job.losses);
  *message.mutable_progress() = ToProto(job.progress);
  if (job.error) *message.mutable_error() = ToProto(*job.error);
  if (job.checkpoint) *message.mutable_checkpoint() = ToProto(*job.checkpoint);
  for (const api::JobArtifact& artifact : job.artifacts) {
    *message.add_artifacts() = ToProto(artifact);
  }
  for (const api::JobAttempt& attempt : job.attempts)
    *message.add_attempts() = AttemptToProto(attempt);
  message.set_event_seq(job.event_seq);
  SetTime(job.create_time, &v1::Job::mutable_create_time, message);
  SetTime(job.start_time, &v1::Job::mutable_start_time, message);
  SetTime(job.end_time, &v1::Job::mutable_end_time, message);
  SetTime(job.expire_time, &v1::Job::mutable_expire_time, message);
  SetTime(job.next_attempt_time, &v1::Job::mutable_next_attempt_time, message);
  if (!job.retry_of.empty()) message.set_retry_of(JobName(job.retry_of));
  message.set_trace_id(job.trace_id);
  message.set_cancel_requested_by(ValidUtf8(job.cancel_requested_by));
  message.set_worker(ValidUtf8(job.worker));
  return message;
}

StatusOr<api::Job> FromProto(const v1::Job& message) {
  api::Job job;
  POISE_ASSIGN_OR_RETURN(job.id, JobId(message.name()));
  POISE_ASSIGN_OR_RETURN(job.state, FromProto(message.state()));
  POISE_ASSIGN_OR_RETURN(job.spec, FromProto(message.spec()));
  job.request_id = message.request_id();
  job.queue = message.queue();
  job.priority = message.priority();
  job.seed = message.seed();
  job.labels.insert(message.labels().begin(), message.labels().end());
  POISE_ASSIGN_OR_RETURN(job.limits, FromProto(message.limits()));
  job.attempt = message.attempt();
  job.errors = message.errors();
  job.losses = message.losses();
  job.progress = FromProto(message.progress());
  if (message.has_error()) job.error = FromProto(message.error());
  if (message.has_checkpoint()) job.checkpoint = FromProto(message.checkpoint());
  for (const v1::JobArtifact& artifact : message.artifacts()) {
    job.artifacts.push_back(FromProto(artifact));
  }
  for (const v1::JobAttempt& attempt : message.attempts()) {
    POISE_ASSIGN_OR_RETURN(api::JobAttempt converted, AttemptFromProto(attempt));
    job.attempts.push_back(std::move(converted));
  }
  job.event_seq = message.event_seq();
  job.create_time = FromProto(message.create_time());
  job.start_time = TimeOrNever(message.has_start_time(), message.start_time());
  job.end_time = TimeOrNever(message.has_end_time(), message.end_time());
  job.expire_time = TimeOrNever(message.has_expire_time(), message.expire_time());
  job.next_attempt_time = TimeOrNever(message.has_next_attempt_time(), message.next_attempt_time());
  if (!message.retry_of().empty()) {
    POISE_ASSIGN_OR_RETURN(job.retry_of, JobId(message.retry_of()));
  }
  job.trace_id = message.trace_id();
  job.cancel_requested_by = message.cancel_requested_by();
  job.worker = message.worker();
  return job;
}

v1::CreateJobRequest ToProto(const api::CreateJob& request) {
  v1::CreateJobRequest message;
  *message.mutable_spec() = ToProto(request.spec);
  message.set_request_id(ValidUtf8(request.request_id));
  message.set_queue(ValidUtf8(request.queue));
  message.set_priority(request.priority);
  message.set_seed(request.seed);
  for (const auto& [key, value] : request.labels) {
    (*message.mutable_labels())[ValidUtf8(key)] = ValidUtf8(value);
  }
  *message.mutable_limits() = ToProto(request.limits);
  return message;
}

StatusOr<api::CreateJob> FromProto(const v1::CreateJobRequest& message) {
  api::CreateJob request;
  POISE_ASSIGN_OR_RETURN(request.spec, FromProto(message.spec()));
  request.request_id = message.request_id();
  if (!message.queue().empty()) request.queue = message.queue();
  request.priority = message.priority();
  request.seed = message.seed();
  request.labels.insert(message.labels().begin(), message.labels().end());
  POISE_ASSIGN_OR_RETURN(request.limits, FromProto(message.limits()));
  POISE_RETURN_IF_ERROR(request.Validate());
  return request;
}

}  // namespace poise::convert
