#include "server/handlers/push_handler.h"

#include <utility>

#include "proto/convert/push_convert.h"
#include "server/handlers/message_stream.h"
#include "server/handlers/refusal.h"
#include "server/handlers/wire.h"

namespace poise::server {
namespace {

// A frame follows from the one before: one message at a time is under way.
constexpr int kWindow = 1;

class ForecastStream : public MessageStream {
 public:
  ForecastStream(Setup setup, grpc::ByteBuffer request, engine::Engine& engine,
                 base::Counter& frames)
      : MessageStream(std::move(setup)),
        request_(std::move(request)),
        engine_(engine),
        frames_(frames) {}

 private:
  StatusOr<int64_t> Prepare(const base::RunContext& context) override {
    POISE_ASSIGN_OR_RETURN(const v1::PushForecastRequest request,
                           Parse<v1::PushForecastRequest>(std::move(request_)));
    POISE_ASSIGN_OR_RETURN(api::PushSpec spec, convert::FromProto(request));
    POISE_ASSIGN_OR_RETURN(flow_, engine_.PreparePush(std::move(spec), context));
    return flow_->scene().frames + 1;
  }

  StatusOr<grpc::ByteBuffer> Make(int64_t ordinal, const base::RunContext& context) override {
    v1::PushForecastResponse response;
    if (ordinal == 0) {
      *response.mutable_scene() = convert::ToProto(flow_->scene());
      return Serialize(response);
    }
    POISE_ASSIGN_OR_RETURN(const api::PushForecastFrame frame, flow_->Next(context));
    frames_.Increment();
    *response.mutable_frame() = convert::ToProto(frame);
    return Serialize(response);
  }

  grpc::ByteBuffer request_;
  engine::Engine& engine_;
  base::Counter& frames_;
  std::unique_ptr<pipeline::PushFlow> flow_;
};

}  // namespace

PushHandler::PushHandler(engine::Engine& engine, Admission& admission, const MethodPolicy& policy,
                         base::Telemetry& telemetry)
    : engine_(engine),
      admission_(admission),
      policy_(policy),
      frames_(telemetry.counter("poise_push_frames_total", "Frames of push forecasts made", {})) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* PushHandler::Forecast(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policy_);
  if (!call.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(call.status());
  return MessageStream::Start(std::make_shared<ForecastStream>(
      MessageStream::Setup{context, *std::move(call), &engine_.compute(), &engine_.compute(),
                           kWindow},
      *request, engine_, frames_));
}

}  // namespace poise::server
