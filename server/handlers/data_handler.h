#ifndef POISE_SERVER_HANDLERS_DATA_HANDLER_H_
#define POISE_SERVER_HANDLERS_DATA_HANDLER_H_

#include "core/artifacts/data_set_registry.h"
#include "core/base/thread_pool.h"
#include "poise/v1/data_service.grpc.pb.h"
#include "server/admission/admission.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.DataService.
/// Threads: gRPC calls from many. Files are read and written on a thread of its own.
class DataHandler : public v1::DataService::WithRawCallbackMethod_CreateDataSet<
                        v1::DataService::WithRawCallbackMethod_GetDataSet<
                            v1::DataService::WithRawCallbackMethod_ListDataSets<
                                v1::DataService::WithRawCallbackMethod_DeleteDataSet<
                                    v1::DataService::Service>>>> {
 public:
  DataHandler(artifacts::DataSetRegistry& data_sets, Admission& admission,
              const MethodPolicies& policies);

  grpc::ServerUnaryReactor* CreateDataSet(grpc::CallbackServerContext* context,
                                          const grpc::ByteBuffer* request,
                                          grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* GetDataSet(grpc::CallbackServerContext* context,
                                       const grpc::ByteBuffer* request,
                                       grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* ListDataSets(grpc::CallbackServerContext* context,
                                         const grpc::ByteBuffer* request,
                                         grpc::ByteBuffer* response) override;
  grpc::ServerUnaryReactor* DeleteDataSet(grpc::CallbackServerContext* context,
                                          const grpc::ByteBuffer* request,
                                          grpc::ByteBuffer* response) override;

 private:
  artifacts::DataSetRegistry& data_sets_;
  const MethodPolicy policy_;
  base::ThreadPool files_{1};
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_DATA_HANDLER_H_
