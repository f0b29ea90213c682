#ifndef POISE_SERVER_HANDLERS_OPERATIONS_HANDLER_H_
#define POISE_SERVER_HANDLERS_OPERATIONS_HANDLER_H_

#include "core/engine/job_manager.h"
#include "google/longrunning/operations.grpc.pb.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// google.longrunning.Operations: the jobs, as clients know them that do not know ours. An
/// operation's name is the job's, its metadata is the Job, its response the Job too, or its error.
/// Threads: as JobHandler.
class OperationsHandler
    : public google::longrunning::Operations::WithRawCallbackMethod_GetOperation<
          google::longrunning::Operations::WithRawCallbackMethod_ListOperations<
              google::longrunning::Operations::WithRawCallbackMethod_CancelOperation<
                  google::longrunning::Operations::WithRawCallbackMethod_DeleteOperation<
                      google::longrunning::Operations::WithRawCallbackMethod_WaitOperation<
                          google::longrunning::Operations::Service>>>>> {
 public:
  OperationsHandler(engine::JobManager& jobs, base::ThreadPool& pool, Admission& admission,
                    const MethodPolicies& policies, const DrainState& drain);

  grpc::ServerUnaryReactor* GetOperation(grpc::CallbackServerContext* context,
                                         const grpc::ByteBuffer* request,
                                         grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ListOperations(grpc::CallbackServerContext* context,
                                           const grpc::ByteBuffer* request,
                                           grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* CancelOperation(grpc::CallbackServerContext* context,
                                            const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* DeleteOperation(grpc::CallbackServerContext* context,
                                            const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;
  /// Answers with the operation as it is when it is done, the timeout is over or the server stops.
  grpc::ServerUnaryReactor* WaitOperation(grpc::CallbackServerContext* context,
                                          const grpc::ByteBuffer* request,
                                          grpc::ByteBuffer* response) override;

 private:
  engine::JobManager& jobs_;
  const MethodPolicies policies_;
  const DrainState& drain_;
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_OPERATIONS_HANDLER_H_
