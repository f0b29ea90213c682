#include "server/handlers/predict_stream.h"

#include <utility>

#include "proto/convert/predict_convert.h"
#include "proto/convert/status_convert.h"
#include "server/handlers/guard.h"
#include "server/handlers/wire.h"

namespace poise::server {

PredictStream::PredictStream(grpc::CallbackServerContext* context, std::unique_ptr<Call> call,
                             engine::Forecaster& forecaster)
    : context_(context), call_(std::move(call)), forecaster_(forecaster) {}

PredictStream::Reactor* PredictStream::Start(std::shared_ptr<PredictStream> stream) {
  PredictStream* reactor = stream.get();
  reactor->self_ = stream;
  reactor->deadline_alarm_.Set(absl::ToChronoTime(reactor->call_->run().deadline),
                               [weak = std::weak_ptr(stream)](bool expired) {
                                 if (auto self = weak.lock(); self && expired) self->Expire();
                               });
  reactor->StartRead(&reactor->request_);
  return reactor;
}

void PredictStream::OnReadDone(bool ok) {
  if (!ok) {
    End(context_->IsCancelled()
            ? base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the client is gone")
            : absl::OkStatus());
    return;
  }
  forecaster_.threads().Submit([self = shared_from_this()] {
    auto answer = Guarded(*self->call_, [&] { return self->Answer(); });
    if (!answer.ok()) return self->End(answer.status());
    if (!answer->has_value()) return self->StartRead(&self->request_);
    self->response_ = **std::move(answer);
    self->StartWrite(&self->response_);
  });
}

void PredictStream::OnWriteDone(bool ok) {
  if (ok) return StartRead(&request_);
  End(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the client is gone"));
}

StatusOr<std::optional<grpc::ByteBuffer>> PredictStream::Answer() {
  POISE_RETURN_IF_ERROR(call_->run().Check());
  POISE_ASSIGN_OR_RETURN(const auto request,
                         Parse<v1::PredictStreamRequest>(std::exchange(request_, {})));
  if (!stream_) {
    if (!request.has_setup()) {
      return base::InvalidArgument("MISSING_SETUP", "message",
                                   "the first message must say whose frames will come");
    }
    POISE_RETURN_IF_ERROR(base::Annotate(Open(request.setup()), "setup", "setup"));
    return std::optional<grpc::ByteBuffer>();
  }
  if (!request.has_frames()) {
    return base::InvalidArgument("UNEXPECTED_MESSAGE", "message",
                                 "after the first message, frames are expected");
  }
  const auto frames = convert::FromProto(request.frames(), skeleton_, frame_rate_);
  if (!frames.ok()) return base::Annotate(frames.status(), "frames", "frames");
  stream_->live.Observe(*frames);
  POISE_ASSIGN_OR_RETURN(const auto future, stream_->live.Next(call_->run()));
  if (!future) return std::optional<grpc::ByteBuffer>();
  v1::PredictStreamResponse response;
  response.set_observed_frames(stream_->live.observed_frames());
  convert::WriteFuture(future->clip, response);
  if (!std::exchange(described_, true)) {
    response.set_model(stream_->model);
    response.set_version(stream_->version);
    response.mutable_frame_times_s()->Add(future->times_s.begin(), future->times_s.end());
  }
  return std::optional<grpc::ByteBuffer>(Serialize(response));
}

Status PredictStream::Open(const v1::PredictStreamSetup& setup) {
  POISE_ASSIGN_OR_RETURN(const api::ForecastStreamSpec spec, convert::FromProto(setup));
  POISE_ASSIGN_OR_RETURN(stream_, forecaster_.Open(spec));
  skeleton_ = spec.skeleton;
  frame_rate_ = spec.frame_rate;
  return absl::OkStatus();
}

void PredictStream::End(const Status& status) {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(ended_, true)) return;
  }
  Finish(convert::ToGrpc(status));
}

// Work stops at the next check; a client that sends nothing has to be woken.
void PredictStream::Expire() {
  call_->Cancel();
  std::lock_guard lock(mutex_);
  if (!ended_) context_->TryCancel();
}

void PredictStream::OnDone() {
  deadline_alarm_.Cancel();
  self_.reset();
}

}  // namespace poise::server
