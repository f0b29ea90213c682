#include "server/handlers/unary_call.h"

#include <utility>

#include "proto/convert/status_convert.h"
#include "server/handlers/guard.h"

namespace poise::server {

UnaryCall::UnaryCall(Setup setup)
    : call_(std::move(setup.call)), pool_(*setup.pool), response_(setup.response) {}

grpc::ServerUnaryReactor* UnaryCall::Start(std::shared_ptr<UnaryCall> call) {
  UnaryCall* reactor = call.get();
  reactor->self_ = call;
  // The alarm outlives the call in gRPC's hands: it must not keep it alive.
  reactor->deadline_alarm_.Set(
      absl::ToChronoTime(reactor->call_->run().deadline),
      [weak = std::weak_ptr(call)](bool expired) {
        auto self = weak.lock();
        if (!self || !expired) return;
        self->call_->Cancel();
        self->End(base::MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
                                  "the deadline passed before there was an answer"));
      });
  call->Wake();
  return reactor;
}

void UnaryCall::Wake() {
  std::lock_guard lock(mutex_);
  if (ended_) return;
  if (state_ != State::kIdle) {
    state_ = State::kRunAgain;
    return;
  }
  state_ = State::kRunning;
  pool_.Submit([self = shared_from_this()] { self->Run(); });
}

void UnaryCall::WakeAt(absl::Time time) {
  std::lock_guard lock(mutex_);
  if (ended_) return;
  wake_alarm_.Set(absl::ToChronoTime(time), [weak = weak_from_this()](bool expired) {
    if (auto self = weak.lock(); self && expired) self->Wake();
  });
}

void UnaryCall::Run() {
  for (;;) {
    Answer answer = TryNow();
    if (!answer.ok()) {
      End(answer.status());
    } else if (answer->has_value()) {
      End(**std::move(answer));
    }
    std::lock_guard lock(mutex_);
    if (ended_) break;
    if (state_ == State::kRunning) {
      state_ = State::kIdle;
      return;
    }
    state_ = State::kRunning;
  }
  OnEnded();
}

UnaryCall::Answer UnaryCall::TryNow() {
  return Guarded(*call_, [this]() -> Answer {
    POISE_RETURN_IF_ERROR(call_->run().Check());
    return Try();
  });
}

void UnaryCall::End(const StatusOr<grpc::ByteBuffer>& answer) {
  bool idle = false;
  {
    std::lock_guard lock(mutex_);
    if (ended_) return;
    ended_ = true;
    idle = state_ == State::kIdle;
    if (answer.ok()) *response_ = *answer;
    Finish(convert::ToGrpc(answer.status()));
  }
  if (idle) OnEnded();
}

void UnaryCall::OnCancel() {
  call_->Cancel();
  End(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "",
                      "the caller cancelled the call, or its deadline passed"));
}

void UnaryCall::OnDone() {
  deadline_alarm_.Cancel();
  wake_alarm_.Cancel();
  self_.reset();
}

}  // namespace poise::server
