#ifndef POISE_SERVER_HANDLERS_ADMIN_HANDLER_H_
#define POISE_SERVER_HANDLERS_ADMIN_HANDLER_H_

#include "core/engine/job_manager.h"
#include "poise/v1/admin_service.grpc.pb.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.AdminService.
/// Threads: gRPC calls from many. What an operator asks for takes long and has a thread of its own,
/// so that no job waits for it.
class AdminHandler
    : public v1::AdminService::WithRawCallbackMethod_Diagnose<
          v1::AdminService::WithRawCallbackMethod_BackUpStore<v1::AdminService::Service>> {
 public:
  AdminHandler(engine::JobManager& jobs, Admission& admission, const MethodPolicy& policy);

  grpc::ServerUnaryReactor* Diagnose(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* BackUpStore(grpc::CallbackServerContext* context,
                                        const grpc::ByteBuffer* request,
                                        grpc::ByteBuffer* response) override;

 private:
  engine::JobManager& jobs_;
  const MethodPolicy policy_;
  base::ThreadPool pool_{1};
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_ADMIN_HANDLER_H_
