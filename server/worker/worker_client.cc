#include "server/worker/worker_client.h"

#include "client/artifact_transfer.h"
#include "core/base/json.h"
#include "core/base/sha256.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/time_convert.h"

namespace poise::worker {
namespace {

using grpc::ClientContext;

// Of calls that do one short thing. Long enough for a disk that is slow today.
constexpr absl::Duration kShortCall = absl::Seconds(10);
// Beyond the time that a long poll is asked to wait.
constexpr absl::Duration kAnswerMargin = absl::Seconds(10);

v1::Fence ToProto(const jobs::Fence& fence) {
  v1::Fence message;
  message.set_job(convert::JobName(fence.job));
  message.set_attempt(fence.attempt);
  message.set_token(fence.token);
  return message;
}

v1::Usage ToProto(const api::JobUsage& usage) {
  v1::Usage message;
  message.set_cpu_seconds(usage.cpu_seconds);
  message.set_peak_memory_bytes(usage.peak_memory_bytes);
  return message;
}

StatusOr<jobs::Lease> FromProto(const v1::Lease& message) {
  jobs::Lease lease;
  POISE_ASSIGN_OR_RETURN(lease.fence.job, convert::JobId(message.fence().job()));
  lease.fence.attempt = message.fence().attempt();
  lease.fence.token = message.fence().token();
  lease.expires_in = convert::FromProto(message.expires_in());
  lease.spec.kind = message.kind();
  POISE_ASSIGN_OR_RETURN(lease.spec.parameters,
                         base::ParseJson(message.parameters_json(), "parameters"));
  lease.seed = message.seed();
  POISE_ASSIGN_OR_RETURN(lease.limits, convert::FromProto(message.limits()));
  if (message.has_checkpoint()) lease.checkpoint = convert::FromProto(message.checkpoint());
  lease.trace_id = message.trace_id();
  if (message.has_deadline_in()) lease.deadline_in = convert::FromProto(message.deadline_in());
  return lease;
}

v1::FinishJobRequest ToProto(const jobs::Fence& fence, const jobs::Outcome& outcome) {
  v1::FinishJobRequest request;
  *request.mutable_fence() = ToProto(fence);
  request.set_outcome(convert::ToProto(outcome.outcome));
  if (outcome.error) *request.mutable_error() = convert::ToProto(*outcome.error);
  for (const api::JobArtifact& artifact : outcome.artifacts) {
    *request.add_artifacts() = convert::ToProto(artifact);
  }
  *request.mutable_usage() = ToProto(outcome.usage);
  return request;
}

}  // namespace

void CallBreaker::Break() {
  std::lock_guard lock(mutex_);
  broken_ = true;
  if (context_ != nullptr) context_->TryCancel();
}

bool CallBreaker::broken() const {
  std::lock_guard lock(mutex_);
  return broken_;
}

void CallBreaker::Enter(ClientContext& context) {
  std::lock_guard lock(mutex_);
  context_ = &context;
  if (broken_) context.TryCancel();
}

void CallBreaker::Leave() {
  std::lock_guard lock(mutex_);
  context_ = nullptr;
}

WorkerClient::WorkerClient(client::ClientOptions options) : connection_(std::move(options)) {}

StatusOr<absl::Duration> WorkerClient::Register(const jobs::WorkerInfo& worker) {
  v1::RegisterWorkerRequest request;
  request.set_worker(worker.id);
  request.set_host(worker.host);
  request.set_engine(worker.engine);
  request.set_engine_ref(worker.engine_ref);
  request.set_version(worker.version);
  request.set_slots(worker.slots);
  const auto context = connection_.NewCall(kShortCall);
  v1::RegisterWorkerResponse response;
  POISE_RETURN_IF_ERROR(
      connection_.Explain(connection_.worker().RegisterWorker(context.get(), request, &response)));
  return convert::FromProto(response.heartbeat_interval());
}

StatusOr<LeaseAnswer> WorkerClient::LeaseJob(const jobs::ClaimQuery& query, absl::Duration wait,
                                             CallBreaker& breaker) {
  v1::LeaseJobRequest request;
  request.set_worker(query.worker);
  request.set_token(query.token);
  *request.mutable_wait() = convert::ToProto(wait);
  request.mutable_queues()->Assign(query.queues.begin(), query.queues.end());
  request.mutable_kinds()->Assign(query.kinds.begin(), query.kinds.end());
  const auto context = connection_.NewCall(wait + kAnswerMargin);
  v1::LeaseJobResponse response;
  breaker.Enter(*context);
  const grpc::Status status = connection_.worker().LeaseJob(context.get(), request, &response);
  breaker.Leave();
  POISE_RETURN_IF_ERROR(connection_.Explain(status));
  LeaseAnswer answer{.lease = {}, .draining = response.draining()};
  if (response.has_lease()) {
    POISE_ASSIGN_OR_RETURN(answer.lease, FromProto(response.lease()));
  }
  return answer;
}

StatusOr<jobs::HeartbeatReply> WorkerClient::Heartbeat(
    const jobs::Fence& fence, const std::optional<base::Progress>& progress, absl::Duration hold,
    absl::Duration limit, CallBreaker& breaker) {
  v1::HeartbeatRequest request;
  *request.mutable_fence() = ToProto(fence);
  if (progress) *request.mutable_progress() = convert::ToProto(*progress);
  *request.mutable_hold() = convert::ToProto(hold);
  const auto context = connection_.NewCall(limit);
  v1::HeartbeatResponse response;
  breaker.Enter(*context);
  const grpc::Status status = connection_.worker().Heartbeat(context.get(), request, &response);
  breaker.Leave();
  POISE_RETURN_IF_ERROR(connection_.Explain(status));
  return jobs::HeartbeatReply{.directive = response.directive() == v1::HeartbeatResponse::CANCEL
                                               ? jobs::Directive::kCancel
                                               : jobs::Directive::kContinue,
                              .expires_in = convert::FromProto(response.expires_in())};
}

Status WorkerClient::CommitCheckpoint(const jobs::Fence& fence, const std::string& artifact,
                                      int64_t step) {
  v1::CommitCheckpointRequest request;
  *request.mutable_fence() = ToProto(fence);
  request.set_artifact(artifact);
  request.set_step(step);
  const auto context = connection_.NewCall(kShortCall);
  google::protobuf::Empty response;
  return connection_.Explain(
      connection_.worker().CommitCheckpoint(context.get(), request, &response));
}

StatusOr<api::JobState> WorkerClient::Finish(const jobs::Fence& fence,
                                             const jobs::Outcome& outcome) {
  const auto context = connection_.NewCall(kShortCall);
  v1::FinishJobResponse response;
  POISE_RETURN_IF_ERROR(connection_.Explain(
      connection_.worker().FinishJob(context.get(), ToProto(fence, outcome), &response)));
  return convert::FromProto(response.state());
}

Status WorkerClient::Release(const jobs::Fence& fence, const api::JobUsage& usage) {
  v1::ReleaseJobRequest request;
  *request.mutable_fence() = ToProto(fence);
  *request.mutable_usage() = ToProto(usage);
  const auto context = connection_.NewCall(kShortCall);
  google::protobuf::Empty response;
  return connection_.Explain(connection_.worker().ReleaseJob(context.get(), request, &response));
}

StatusOr<std::string> WorkerClient::Upload(std::string_view bytes) {
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored,
                         client::Upload(connection_, client::MemorySource(bytes)));
  return stored.name;
}

StatusOr<std::string> WorkerClient::UploadFile(const std::filesystem::path& path) {
  POISE_ASSIGN_OR_RETURN(const client::UploadSource source, client::FileSource(path));
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client::Upload(connection_, source));
  return stored.name;
}

StatusOr<std::string> WorkerClient::Download(const std::string& artifact) {
  std::string bytes;
  POISE_RETURN_IF_ERROR(
      client::Download(connection_, artifact, 0, [&bytes](std::string_view piece) {
        bytes += piece;
        return absl::OkStatus();
      }));
  if (client::IsNamed(artifact, base::Sha256Hex(bytes))) return bytes;
  return base::Internal("CORRUPTED", "what came for '" + artifact + "' does not hash to its name");
}

Status WorkerClient::DownloadFile(const std::string& artifact, const std::filesystem::path& path) {
  return client::DownloadToFile(connection_, artifact, path);
}

bool IsDefinite(const Status& status) {
  if (base::ErrorReason(status) == "CORRUPTED") return true;  // and stays so
  switch (status.code()) {
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
    case absl::StatusCode::kResourceExhausted:
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kCancelled:
      return false;
    default:
      return true;
  }
}

}  // namespace poise::worker
