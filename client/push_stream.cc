#include "client/push_stream.h"

#include "client/push_call.h"
#include "client/transport_error.h"
#include "proto/convert/push_convert.h"

namespace poise::client {
namespace {

Status BadAnswer() {
  return base::Internal("BAD_ANSWER", "the server's stream is not a scene and then its frames");
}

}  // namespace

PushStream::PushStream(std::unique_ptr<Call> call) : call_(std::move(call)) {}

PushStream::~PushStream() {
  if (call_->outcome_) return;
  call_->context_->TryCancel();
  call_->reader_->Finish();  // gRPC wants every call to be finished
}

StatusOr<api::PushForecastScene> PushStream::Scene() {
  v1::PushForecastResponse response;
  if (!call_->outcome_ && call_->reader_->Read(&response)) {
    if (!response.has_scene()) return BadAnswer();
    return convert::FromProto(response.scene());
  }
  POISE_RETURN_IF_ERROR(Next().status());
  return BadAnswer();
}

StatusOr<std::optional<api::PushForecastFrame>> PushStream::Next() {
  v1::PushForecastResponse response;
  if (!call_->outcome_ && call_->reader_->Read(&response)) {
    if (!response.has_frame()) return BadAnswer();
    POISE_ASSIGN_OR_RETURN(api::PushForecastFrame frame, convert::FromProto(response.frame()));
    return std::optional<api::PushForecastFrame>(std::move(frame));
  }
  if (!call_->outcome_) {
    call_->outcome_ = ExplainCall(call_->reader_->Finish(), call_->connection_.options());
  }
  POISE_RETURN_IF_ERROR(*call_->outcome_);
  return std::optional<api::PushForecastFrame>();
}

void PushStream::Cancel() { call_->context_->TryCancel(); }

}  // namespace poise::client
