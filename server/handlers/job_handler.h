#ifndef POISE_SERVER_HANDLERS_JOB_HANDLER_H_
#define POISE_SERVER_HANDLERS_JOB_HANDLER_H_

#include "core/artifacts/artifact_store.h"
#include "core/engine/job_manager.h"
#include "poise/v1/job_service.grpc.pb.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.JobService.
/// Threads: gRPC calls from many. The store is called on the pool, which waits for disks.
class JobHandler : public v1::JobService::WithRawCallbackMethod_CreateJob<
                       v1::JobService::WithRawCallbackMethod_GetJob<
                           v1::JobService::WithRawCallbackMethod_ListJobs<
                               v1::JobService::WithRawCallbackMethod_CancelJob<
                                   v1::JobService::WithRawCallbackMethod_WatchJob<
                                       v1::JobService::WithRawCallbackMethod_GetJobResult<
                                           v1::JobService::WithRawCallbackMethod_DeleteJob<
                                               v1::JobService::WithRawCallbackMethod_RetryJob<
                                                   v1::JobService::Service>>>>>>>> {
 public:
  /// A watch shows the job anew after `snapshot_interval` in which nothing happened.
  JobHandler(engine::JobManager& jobs, artifacts::ArtifactStore& artifacts, base::ThreadPool& pool,
             Admission& admission, const MethodPolicies& policies, const DrainState& drain,
             absl::Duration snapshot_interval);

  grpc::ServerUnaryReactor* CreateJob(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* context,
                                   const grpc::ByteBuffer* request,
                                   grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchJob(grpc::CallbackServerContext* context,
                                                       const grpc::ByteBuffer* request) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* GetJobResult(
      grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* DeleteJob(grpc::CallbackServerContext* context,
                                      const grpc::ByteBuffer* request,
                                      grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* RetryJob(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;

 private:
  engine::JobManager& jobs_;
  artifacts::ArtifactStore& artifacts_;
  base::ThreadPool& pool_;
  Admission& admission_;
  const MethodPolicies policies_;
  const DrainState& drain_;
  const absl::Duration snapshot_interval_;
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_JOB_HANDLER_H_
