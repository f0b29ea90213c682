#ifndef POISE_SERVER_HANDLERS_WORKER_HANDLER_H_
#define POISE_SERVER_HANDLERS_WORKER_HANDLER_H_

#include "core/engine/job_manager.h"
#include "poise/v1/worker_service.grpc.pb.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.WorkerService.
/// Threads: as JobHandler.
class WorkerHandler : public v1::WorkerService::WithRawCallbackMethod_RegisterWorker<
                          v1::WorkerService::WithRawCallbackMethod_LeaseJob<
                              v1::WorkerService::WithRawCallbackMethod_Heartbeat<
                                  v1::WorkerService::WithRawCallbackMethod_CommitCheckpoint<
                                      v1::WorkerService::WithRawCallbackMethod_FinishJob<
                                          v1::WorkerService::WithRawCallbackMethod_ReleaseJob<
                                              v1::WorkerService::Service>>>>>> {
 public:
  WorkerHandler(engine::JobManager& jobs, base::ThreadPool& pool, Admission& admission,
                const MethodPolicy& policy, const DrainState& drain);

  grpc::ServerUnaryReactor* RegisterWorker(grpc::CallbackServerContext* context,
                                           const grpc::ByteBuffer* request,
                                           grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* LeaseJob(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* Heartbeat(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* CommitCheckpoint(grpc::CallbackServerContext* context,
                                             const grpc::ByteBuffer* request,
                                             grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* FinishJob(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ReleaseJob(grpc::CallbackServerContext* context,
                                       const grpc::ByteBuffer* request,
                                       grpc::ByteBuffer* response) override;

 private:
  engine::JobManager& jobs_;
  const MethodPolicy policy_;
  const DrainState& drain_;
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_WORKER_HANDLER_H_
