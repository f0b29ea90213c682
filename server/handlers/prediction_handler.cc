#include "server/handlers/prediction_handler.h"

#include <utility>

#include "proto/convert/predict_convert.h"
#include "server/handlers/predict_stream.h"

namespace poise::server {

PredictionHandler::PredictionHandler(engine::Engine& engine, Admission& admission,
                                     const MethodPolicies& policies)
    : engine_(engine),
      admission_(admission),
      policies_(policies),
      unary_(admission, engine.forecaster().threads()) {}

grpc::ServerUnaryReactor* PredictionHandler::Predict(grpc::CallbackServerContext* context,
                                                     const grpc::ByteBuffer* request,
                                                     grpc::ByteBuffer* response) {
  return unary_.Answer<v1::PredictRequest>(
      {context, request, response}, policies_.predict,
      [this](const v1::PredictRequest& message, const Call& call) -> StatusOr<v1::PredictResponse> {
        POISE_ASSIGN_OR_RETURN(api::PredictQuery query, convert::FromProto(message));
        POISE_ASSIGN_OR_RETURN(const api::Forecast forecast,
                               engine_.forecaster().Predict(std::move(query), call.run()));
        return convert::ToProto(forecast);
      });
}

grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>* PredictionHandler::PredictStream(
    grpc::CallbackServerContext* context) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policies_.predict_stream);
  if (!call.ok()) return new Refusal<server::PredictStream::Reactor>(call.status());
  return server::PredictStream::Start(
      std::make_shared<server::PredictStream>(context, *std::move(call), engine_.forecaster()));
}

}  // namespace poise::server
