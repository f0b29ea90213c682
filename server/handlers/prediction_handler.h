#ifndef POISE_SERVER_HANDLERS_PREDICTION_HANDLER_H_
#define POISE_SERVER_HANDLERS_PREDICTION_HANDLER_H_

#include "core/engine/engine.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "server/handlers/unary_methods.h"

namespace poise::server {

/// poise.v1.PredictionService.
/// Threads: gRPC calls from many. Predictions are made on the forecaster's threads.
class PredictionHandler : public v1::PredictionService::WithRawCallbackMethod_Predict<
                              v1::PredictionService::WithRawCallbackMethod_PredictStream<
                                  v1::PredictionService::Service>> {
 public:
  PredictionHandler(engine::Engine& engine, Admission& admission, const MethodPolicies& policies);

  grpc::ServerUnaryReactor* Predict(grpc::CallbackServerContext* context,
                                    const grpc::ByteBuffer* request,
                                    grpc::ByteBuffer* response) override;
  grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* PredictStream(
      grpc::CallbackServerContext* context) override;

 private:
  engine::Engine& engine_;
  Admission& admission_;
  const MethodPolicies policies_;
  UnaryMethods unary_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_PREDICTION_HANDLER_H_
