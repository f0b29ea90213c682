#include "server/handlers/job_handler.h"

#include <utility>

#include "google/protobuf/empty.pb.h"
#include "proto/convert/job_convert.h"
#include "server/handlers/job_pages.h"
#include "server/handlers/job_result_stream.h"
#include "server/handlers/watch_stream.h"

namespace poise::server {
namespace {

engine::JobCaller CallerOf(const Call& call) {
  return {.tenant = call.tenant(), .trace_id = call.origin().trace_id};
}

StatusOr<v1::Job> Message(const StatusOr<api::Job>& job) {
  POISE_RETURN_IF_ERROR(job.status());
  return convert::ToProto(*job);
}

}  // namespace

JobHandler::JobHandler(engine::JobManager& jobs, artifacts::ArtifactStore& artifacts,
                       base::ThreadPool& pool, Admission& admission, const MethodPolicies& policies,
                       const DrainState& drain, absl::Duration snapshot_interval)
    : jobs_(jobs),
      artifacts_(artifacts),
      pool_(pool),
      admission_(admission),
      policies_(policies),
      drain_(drain),
      snapshot_interval_(snapshot_interval),
      unary_(admission, pool) {}

grpc::ServerUnaryReactor* JobHandler::CreateJob(grpc::CallbackServerContext* context,
                                                const grpc::ByteBuffer* request,
                                                grpc::ByteBuffer* response) {
  return unary_.Answer<v1::CreateJobRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::CreateJobRequest& message, const Call& call) -> StatusOr<v1::Job> {
        POISE_ASSIGN_OR_RETURN(const api::CreateJob wish, convert::FromProto(message));
        return Message(jobs_.Create(CallerOf(call), wish));
      });
}

grpc::ServerUnaryReactor* JobHandler::GetJob(grpc::CallbackServerContext* context,
                                             const grpc::ByteBuffer* request,
                                             grpc::ByteBuffer* response) {
  return unary_.Answer<v1::GetJobRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::GetJobRequest& message, const Call& call) -> StatusOr<v1::Job> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        return Message(jobs_.Get(call.tenant(), id));
      });
}

grpc::ServerUnaryReactor* JobHandler::ListJobs(grpc::CallbackServerContext* context,
                                               const grpc::ByteBuffer* request,
                                               grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ListJobsRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::ListJobsRequest& message,
             const Call& call) -> StatusOr<v1::ListJobsResponse> {
        POISE_ASSIGN_OR_RETURN(api::JobFilter filter, api::JobFilter::Parse(message.filter()));
        return ListPage(jobs_, {.tenant = call.tenant(),
                                .filter = std::move(filter),
                                .page_size = message.page_size(),
                                .page_token = message.page_token()});
      });
}

grpc::ServerUnaryReactor* JobHandler::CancelJob(grpc::CallbackServerContext* context,
                                                const grpc::ByteBuffer* request,
                                                grpc::ByteBuffer* response) {
  return unary_.Answer<v1::CancelJobRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::CancelJobRequest& message, const Call& call) -> StatusOr<v1::Job> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        return Message(jobs_.Cancel(call.tenant(), id, call.origin().peer));
      });
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobHandler::WatchJob(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policies_.watch);
  if (!call.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(call.status());
  return WatchStream::Start(std::make_shared<WatchStream>(
      WatchStream::Setup{context, *std::move(call), *request, &pool_, snapshot_interval_}, jobs_,
      drain_));
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* JobHandler::GetJobResult(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policies_.job_result);
  if (!call.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(call.status());
  return JobResultStream::Start(context, *std::move(call), *request, jobs_, artifacts_, pool_);
}

grpc::ServerUnaryReactor* JobHandler::DeleteJob(grpc::CallbackServerContext* context,
                                                const grpc::ByteBuffer* request,
                                                grpc::ByteBuffer* response) {
  return unary_.Answer<v1::DeleteJobRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::DeleteJobRequest& message,
             const Call& call) -> StatusOr<google::protobuf::Empty> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        POISE_RETURN_IF_ERROR(jobs_.Delete(call.tenant(), id));
        return google::protobuf::Empty();
      });
}

grpc::ServerUnaryReactor* JobHandler::RetryJob(grpc::CallbackServerContext* context,
                                               const grpc::ByteBuffer* request,
                                               grpc::ByteBuffer* response) {
  return unary_.Answer<v1::RetryJobRequest>(
      {context, request, response}, policies_.job,
      [this](const v1::RetryJobRequest& message, const Call& call) -> StatusOr<v1::Job> {
        POISE_ASSIGN_OR_RETURN(const std::string id, convert::JobId(message.name()));
        return Message(jobs_.Retry(CallerOf(call), id, message.request_id()));
      });
}

}  // namespace poise::server
