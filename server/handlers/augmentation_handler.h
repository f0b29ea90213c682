#ifndef POISE_SERVER_HANDLERS_AUGMENTATION_HANDLER_H_
#define POISE_SERVER_HANDLERS_AUGMENTATION_HANDLER_H_

#include "core/base/telemetry.h"
#include "core/base/thread_pool.h"
#include "core/engine/engine.h"
#include "poise/v1/augmentation_service.grpc.pb.h"
#include "server/admission/admission.h"

namespace poise::server {

/// poise.v1.AugmentationService.
/// Threads: gRPC calls from many.
class AugmentationHandler : public v1::AugmentationService::WithRawCallbackMethod_Augment<
                                v1::AugmentationService::Service> {
 public:
  AugmentationHandler(engine::Engine& engine, Admission& admission, const MethodPolicy& policy,
                      base::Telemetry& telemetry);

  grpc::ServerWriteReactor<grpc::ByteBuffer>* Augment(grpc::CallbackServerContext* context,
                                                      const grpc::ByteBuffer* request) override;

 private:
  engine::Engine& engine_;
  Admission& admission_;
  const MethodPolicy policy_;
  base::ThreadPool writers_;  // sending would take a tenth of the compute threads' time
  base::Counter& variants_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_AUGMENTATION_HANDLER_H_
