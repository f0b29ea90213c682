#ifndef POISE_SERVER_HANDLERS_MODEL_HANDLER_H_
#define POISE_SERVER_HANDLERS_MODEL_HANDLER_H_

#include "core/base/thread_pool.h"
#include "core/engine/model_catalog.h"
#include "poise/v1/model_service.grpc.pb.h"
#include "server/admission/admission.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.ModelService.
/// Threads: gRPC calls from many. Files are read and written on a thread of its own.
class ModelHandler : public v1::ModelService::WithRawCallbackMethod_ListModels<
                         v1::ModelService::WithRawCallbackMethod_GetModel<
                             v1::ModelService::WithRawCallbackMethod_ImportModel<
                                 v1::ModelService::WithRawCallbackMethod_ExportModel<
                                     v1::ModelService::WithRawCallbackMethod_SetDefaultModel<
                                         v1::ModelService::WithRawCallbackMethod_DeleteModel<
                                             v1::ModelService::Service>>>>>> {
 public:
  ModelHandler(engine::ModelCatalog& models, Admission& admission, const MethodPolicies& policies);

  grpc::ServerUnaryReactor* ListModels(grpc::CallbackServerContext* context,
                                       const grpc::ByteBuffer* request,
                                       grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetModel(grpc::CallbackServerContext* context,
                                     const grpc::ByteBuffer* request,
                                     grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ImportModel(grpc::CallbackServerContext* context,
                                        const grpc::ByteBuffer* request,
                                        grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ExportModel(grpc::CallbackServerContext* context,
                                        const grpc::ByteBuffer* request,
                                        grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* SetDefaultModel(grpc::CallbackServerContext* context,
                                            const grpc::ByteBuffer* request,
                                            grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* DeleteModel(grpc::CallbackServerContext* context,
                                        const grpc::ByteBuffer* request,
                                        grpc::ByteBuffer* response) override;

 private:
  engine::ModelCatalog& models_;
  const MethodPolicy policy_;
  base::ThreadPool files_{1};
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_MODEL_HANDLER_H_
