#include "server/handlers/worker_convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/runtime/jobs/job_json.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/time_convert.h"

namespace poise::server {
namespace {

// Short ones could be guessed.
constexpr size_t kMinToken = 16;
constexpr size_t kMaxToken = 128;
constexpr int kMaxNames = 64;
constexpr int kMaxArtifacts = 10'000;
constexpr size_t kMaxText = 1000;
constexpr size_t kMaxMetrics = 64;
constexpr int kMaxCode = static_cast<int>(absl::StatusCode::kUnauthenticated);

Status CheckCount(int count, const char* field) {
  if (count <= kMaxNames) return absl::OkStatus();
  return base::InvalidArgument("TOO_MANY_NAMES", field,
                               fmt::format("{} {}, at most {}", count, field, kMaxNames));
}

// What a worker means that tells an error, or not, and no outcome.
api::AttemptOutcome ImpliedOutcome(const v1::FinishJobRequest& request) {
  if (!request.has_error()) return api::AttemptOutcome::kSucceeded;
  const bool cancelled = request.error().code() == static_cast<int>(absl::StatusCode::kCancelled);
  return cancelled ? api::AttemptOutcome::kCancelled : api::AttemptOutcome::kError;
}

StatusOr<api::JobArtifact> ArtifactFromProto(const v1::JobArtifact& message, int index) {
  const std::filesystem::path path(message.name());
  const bool inside = !message.name().empty() && message.name().size() <= kMaxText &&
                      path.is_relative() && message.name().find('\0') == std::string::npos &&
                      std::none_of(path.begin(), path.end(), [](const auto& part) {
                        return part.empty() || part == "." || part == "..";
                      });
  if (inside) return convert::FromProto(message);
  return base::InvalidArgument(
      "BAD_ARTIFACT_PATH", fmt::format("artifacts[{}].name", index),
      "expected a path below the result's folder, like 'variants/0001.bvh'");
}

// Not finite, or negative: not known.
double Usable(double value) { return std::isfinite(value) && value > 0 ? value : 0; }

}  // namespace

StatusOr<jobs::Fence> FromProto(const v1::Fence& fence) {
  const StatusOr<std::string> job = convert::JobId(fence.job());
  if (!job.ok()) {
    return base::InvalidArgument("BAD_JOB_NAME", "fence.job", base::Message(job.status()));
  }
  return jobs::Fence{*job, fence.attempt(), fence.token()};
}

jobs::WorkerInfo FromProto(const v1::RegisterWorkerRequest& request) {
  return {.id = request.worker(),
          .host = request.host(),
          .engine = request.engine(),
          .engine_ref = request.engine_ref(),
          .version = request.version(),
          .slots = request.slots(),
          .last_seen = {}};
}

StatusOr<jobs::ClaimQuery> FromProto(const v1::LeaseJobRequest& request) {
  if (request.worker().empty()) {
    return base::InvalidArgument("BAD_WORKER", "worker", "the worker's name is missing");
  }
  if (request.token().size() < kMinToken || request.token().size() > kMaxToken) {
    return base::InvalidArgument(
        "BAD_LEASE_TOKEN", "token",
        fmt::format("the token has {} characters, expected {} to {} random ones",
                    request.token().size(), kMinToken, kMaxToken));
  }
  POISE_RETURN_IF_ERROR(CheckCount(request.queues_size(), "queues"));
  POISE_RETURN_IF_ERROR(CheckCount(request.kinds_size(), "kinds"));
  return jobs::ClaimQuery{.worker = request.worker(),
                          .token = request.token(),
                          .queues = {request.queues().begin(), request.queues().end()},
                          .kinds = {request.kinds().begin(), request.kinds().end()}};
}

api::JobUsage FromProto(const v1::Usage& usage) {
  return {.cpu_seconds = Usable(usage.cpu_seconds()),
          .peak_memory_bytes = std::max<int64_t>(usage.peak_memory_bytes(), 0)};
}

base::Progress FromWorker(const v1::JobProgress& message) {
  base::Progress progress{.step = message.step(),
                          .total = message.total(),
                          .message = message.message().substr(0, kMaxText)};
  for (const auto& [name, value] : message.metrics()) {
    const bool kept = std::isfinite(value) && name.size() <= kMaxText;
    if (kept && progress.metrics.size() < kMaxMetrics) progress.metrics.emplace(name, value);
  }
  return progress;
}

StatusOr<jobs::Outcome> FromProto(const v1::FinishJobRequest& request) {
  jobs::Outcome outcome{.outcome = ImpliedOutcome(request), .usage = FromProto(request.usage())};
  if (request.outcome() != v1::JobAttempt::OUTCOME_UNSPECIFIED) {
    POISE_ASSIGN_OR_RETURN(outcome.outcome, convert::FromProto(request.outcome()));
  }
  const bool succeeded = outcome.outcome == api::AttemptOutcome::kSucceeded;
  if (outcome.outcome == api::AttemptOutcome::kRunning ||
      outcome.outcome == api::AttemptOutcome::kReleased || (succeeded && request.has_error())) {
    return base::InvalidArgument("BAD_OUTCOME", "outcome",
                                 fmt::format("outcome {} {} an error does not end an attempt",
                                             api::AttemptOutcomeName(outcome.outcome),
                                             request.has_error() ? "with" : "without"));
  }
  if (request.has_error()) {
    outcome.error = convert::FromProto(request.error());
    outcome.error->message = outcome.error->message.substr(0, kMaxText);
    const int code = request.error().code();
    if (code <= 0 || code > kMaxCode) outcome.error->code = absl::StatusCode::kUnknown;
  }
  if (request.artifacts_size() > kMaxArtifacts) {
    return base::InvalidArgument(
        "TOO_MANY_ARTIFACTS", "artifacts",
        fmt::format("{} artifacts, at most {}", request.artifacts_size(), kMaxArtifacts));
  }
  for (int i = 0; succeeded && i < request.artifacts_size(); ++i) {
    POISE_ASSIGN_OR_RETURN(api::JobArtifact artifact, ArtifactFromProto(request.artifacts(i), i));
    outcome.artifacts.push_back(std::move(artifact));
  }
  return outcome;
}

v1::Lease ToProto(const jobs::Lease& lease) {
  v1::Lease message;
  message.mutable_fence()->set_job(convert::JobName(lease.fence.job));
  message.mutable_fence()->set_attempt(lease.fence.attempt);
  message.mutable_fence()->set_token(lease.fence.token);
  *message.mutable_expires_in() = convert::ToProto(lease.expires_in);
  message.set_kind(lease.spec.kind);
  message.set_parameters_json(jobs::ToJson(lease.spec.parameters));
  message.set_seed(lease.seed);
  *message.mutable_limits() = convert::ToProto(lease.limits);
  if (lease.checkpoint) *message.mutable_checkpoint() = convert::ToProto(*lease.checkpoint);
  message.set_trace_id(lease.trace_id);
  if (lease.deadline_in != absl::InfiniteDuration()) {
    *message.mutable_deadline_in() = convert::ToProto(lease.deadline_in);
  }
  return message;
}

v1::HeartbeatResponse ToProto(const jobs::HeartbeatReply& reply) {
  v1::HeartbeatResponse message;
  message.set_directive(reply.directive == jobs::Directive::kCancel
                            ? v1::HeartbeatResponse::CANCEL
                            : v1::HeartbeatResponse::CONTINUE);
  *message.mutable_expires_in() = convert::ToProto(reply.expires_in);
  return message;
}

}  // namespace poise::server
