#include "server/handlers/worker_handler.h"

#include "google/protobuf/empty.pb.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/time_convert.h"
#include "server/handlers/heartbeat_call.h"
#include "server/handlers/lease_call.h"
#include "server/handlers/worker_convert.h"

namespace poise::server {

using google::protobuf::Empty;

WorkerHandler::WorkerHandler(engine::JobManager& jobs, base::ThreadPool& pool, Admission& admission,
                             const MethodPolicy& policy, const DrainState& drain)
    : jobs_(jobs), policy_(policy), drain_(drain), unary_(admission, pool) {}

grpc::ServerUnaryReactor* WorkerHandler::RegisterWorker(grpc::CallbackServerContext* context,
                                                        const grpc::ByteBuffer* request,
                                                        grpc::ByteBuffer* response) {
  return unary_.Answer<v1::RegisterWorkerRequest>(
      {context, request, response}, policy_,
      [this](const v1::RegisterWorkerRequest& message,
             const Call&) -> StatusOr<v1::RegisterWorkerResponse> {
        POISE_RETURN_IF_ERROR(jobs_.RegisterWorker(FromProto(message)));
        v1::RegisterWorkerResponse answer;
        *answer.mutable_heartbeat_interval() =
            convert::ToProto(jobs_.config().policy.heartbeat_interval);
        return answer;
      });
}

grpc::ServerUnaryReactor* WorkerHandler::LeaseJob(grpc::CallbackServerContext* context,
                                                  const grpc::ByteBuffer* request,
                                                  grpc::ByteBuffer* response) {
  return unary_.Start<LeaseCall>({context, request, response}, policy_, jobs_, drain_);
}

grpc::ServerUnaryReactor* WorkerHandler::Heartbeat(grpc::CallbackServerContext* context,
                                                   const grpc::ByteBuffer* request,
                                                   grpc::ByteBuffer* response) {
  return unary_.Start<HeartbeatCall>({context, request, response}, policy_, jobs_, drain_);
}

grpc::ServerUnaryReactor* WorkerHandler::CommitCheckpoint(grpc::CallbackServerContext* context,
                                                          const grpc::ByteBuffer* request,
                                                          grpc::ByteBuffer* response) {
  return unary_.Answer<v1::CommitCheckpointRequest>(
      {context, request, response}, policy_,
      [this](const v1::CommitCheckpointRequest& message, const Call&) -> StatusOr<Empty> {
        POISE_ASSIGN_OR_RETURN(const jobs::Fence fence, FromProto(message.fence()));
        POISE_RETURN_IF_ERROR(jobs_.CommitCheckpoint(fence, message.artifact(), message.step()));
        return Empty();
      });
}

grpc::ServerUnaryReactor* WorkerHandler::FinishJob(grpc::CallbackServerContext* context,
                                                   const grpc::ByteBuffer* request,
                                                   grpc::ByteBuffer* response) {
  return unary_.Answer<v1::FinishJobRequest>(
      {context, request, response}, policy_,
      [this](const v1::FinishJobRequest& message, const Call&) -> StatusOr<v1::FinishJobResponse> {
        POISE_ASSIGN_OR_RETURN(const jobs::Fence fence, FromProto(message.fence()));
        POISE_ASSIGN_OR_RETURN(const jobs::Outcome outcome, FromProto(message));
        POISE_ASSIGN_OR_RETURN(const api::JobState state, jobs_.Finish(fence, outcome));
        v1::FinishJobResponse answer;
        answer.set_state(convert::ToProto(state));
        return answer;
      });
}

grpc::ServerUnaryReactor* WorkerHandler::ReleaseJob(grpc::CallbackServerContext* context,
                                                    const grpc::ByteBuffer* request,
                                                    grpc::ByteBuffer* response) {
  return unary_.Answer<v1::ReleaseJobRequest>(
      {context, request, response}, policy_,
      [this](const v1::ReleaseJobRequest& message, const Call&) -> StatusOr<Empty> {
        POISE_ASSIGN_OR_RETURN(const jobs::Fence fence, FromProto(message.fence()));
        POISE_RETURN_IF_ERROR(jobs_.Release(fence, FromProto(message.usage())));
        return Empty();
      });
}

}  // namespace poise::server
