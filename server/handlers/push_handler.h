#ifndef POISE_SERVER_HANDLERS_PUSH_HANDLER_H_
#define POISE_SERVER_HANDLERS_PUSH_HANDLER_H_

#include "core/base/telemetry.h"
#include "core/base/thread_pool.h"
#include "core/engine/engine.h"
#include "poise/v1/push_service.grpc.pb.h"
#include "server/admission/admission.h"

namespace poise::server {

/// poise.v1.PushService.
/// Threads: gRPC calls from many.
class PushHandler
    : public v1::PushService::WithRawCallbackMethod_Forecast<v1::PushService::Service> {
 public:
  PushHandler(engine::Engine& engine, Admission& admission, const MethodPolicy& policy,
              base::Telemetry& telemetry);

  grpc::ServerWriteReactor<grpc::ByteBuffer>* Forecast(grpc::CallbackServerContext* context,
                                                       const grpc::ByteBuffer* request) override;

 private:
  engine::Engine& engine_;
  Admission& admission_;
  const MethodPolicy policy_;
  base::Counter& frames_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_PUSH_HANDLER_H_
