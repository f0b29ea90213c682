#include "server/handlers/message_stream.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "proto/convert/status_convert.h"
#include "server/handlers/guard.h"

namespace poise::server {

MessageStream::MessageStream(Setup setup)
    : context_(setup.context),
      call_(std::move(setup.call)),
      pool_(*setup.pool),
      writers_(*setup.writers),
      window_(setup.window) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* MessageStream::Start(
    std::shared_ptr<MessageStream> stream) {
  MessageStream* reactor = stream.get();
  reactor->self_ = stream;
  // The alarm outlives the call in gRPC's hands: it must not keep the stream alive.
  reactor->deadline_alarm_.Set(absl::ToChronoTime(reactor->call_->run().deadline),
                               [weak = std::weak_ptr(stream)](bool expired) {
                                 if (auto self = weak.lock(); self && expired) self->Expire();
                               });
  reactor->tasks_ = 1;
  reactor->pool_.Submit([stream = std::move(stream)] { stream->RunPrepare(); });
  return reactor;
}

void MessageStream::RunPrepare() {
  const StatusOr<int64_t> total = Guarded(*call_, [this]() -> StatusOr<int64_t> {
    POISE_RETURN_IF_ERROR(call_->run().Check());
    return Prepare(call_->run());
  });
  std::lock_guard lock(mutex_);
  --tasks_;
  prepared_ = true;
  if (total.ok()) {
    total_ = *total;
  } else {
    Stop(total.status());
  }
  Advance();
}

void MessageStream::RunMake(int64_t ordinal) {
  StatusOr<grpc::ByteBuffer> message =
      Guarded(*call_, [this, ordinal]() -> StatusOr<grpc::ByteBuffer> {
        POISE_RETURN_IF_ERROR(call_->run().Check());
        return Make(ordinal, call_->run());
      });
  std::lock_guard lock(mutex_);
  --tasks_;
  if (message.ok()) message_bytes_ = std::max(message_bytes_, message->Length());
  if (!stop_) ready_.emplace(ordinal, std::move(message));
  // Otherwise the end of the write under way goes on, or the message that is next.
  if (!stop_ && (writing_ || !ready_.contains(written_))) return;
  writers_.Submit([self = shared_from_this()] {
    std::lock_guard lock(self->mutex_);
    self->Advance();
  });
}

void MessageStream::OnWriteDone(bool ok) {
  std::lock_guard lock(mutex_);
  writing_ = false;
  ready_.erase(written_++);
  if (!ok) {
    Stop(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the client is gone"));
  }
  Advance();
}

void MessageStream::OnCancel() {
  call_->Cancel();
  std::lock_guard lock(mutex_);
  Stop(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "",
                       "the caller cancelled the call, or its deadline passed"));
  Advance();
}

void MessageStream::Expire() {
  call_->Cancel();
  std::lock_guard lock(mutex_);
  if (finished_) return;
  Stop(base::MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
                       "the deadline passed before the stream was complete"));
  if (!writing_) return Advance();
  // A client that reads takes the message under way and then learns why the stream ends.
  cut_alarm_.Set(absl::ToChronoTime(absl::Now() + kLastWrite),
                 [weak = weak_from_this()](bool expired) {
                   if (auto self = weak.lock(); self && expired) self->Cut();
                 });
}

void MessageStream::Cut() {
  {
    std::lock_guard lock(mutex_);
    if (finished_ || !writing_) return;
    ++tasks_;  // keeps the context until TryCancel is back
  }
  // The client does not read: only a cancelled stream gives the pending write back.
  context_->TryCancel();
  std::lock_guard lock(mutex_);
  --tasks_;
  Advance();
}

void MessageStream::OnDone() {
  deadline_alarm_.Cancel();
  cut_alarm_.Cancel();
  self_.reset();
}

void MessageStream::Stop(Status status) {
  if (!stop_) stop_ = std::move(status);
  // What a write uses stays until OnWriteDone.
  std::erase_if(ready_, [this](const auto& entry) { return !writing_ || entry.first != written_; });
}

void MessageStream::Advance() {
  if (finished_) return;
  if (!stop_ && prepared_) {
    if (!writing_) BeginWrite();
    if (!stop_) BeginMessages();
  }
  if (tasks_ > 0 || writing_ || !prepared_) return;
  if (!stop_ && written_ < total_) return;
  finished_ = true;
  Finish(convert::ToGrpc(stop_.value_or(absl::OkStatus())));
}

void MessageStream::BeginWrite() {
  const auto next = ready_.find(written_);
  if (next == ready_.end()) return;
  if (!next->second.ok()) {
    const Status status = next->second.status();
    call_->Cancel();  // later messages are made for nobody
    return Stop(status);
  }
  writing_ = true;
  StartWrite(&*next->second);
}

void MessageStream::BeginMessages() {
  const int64_t fitting = static_cast<int64_t>(kWindowBytes / std::max<size_t>(message_bytes_, 1));
  const int64_t window = std::clamp<int64_t>(fitting, 1, window_);
  while (begun_ < total_ && begun_ < written_ + window) {
    ++tasks_;
    pool_.Submit([self = shared_from_this(), ordinal = begun_] { self->RunMake(ordinal); });
    ++begun_;
  }
}

}  // namespace poise::server
