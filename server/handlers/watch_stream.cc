#include "server/handlers/watch_stream.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/time/clock.h"
#include "proto/convert/job_convert.h"
#include "proto/convert/status_convert.h"
#include "server/handlers/guard.h"
#include "server/handlers/wire.h"

namespace poise::server {
namespace {

// Clients that are sent away together do not come back together.
constexpr absl::Duration kRejoinDelay = absl::Seconds(1);

Status JoinAgain(const char* reason, const char* why) {
  return base::WithRetryDelay(base::MakeError(absl::StatusCode::kUnavailable, reason, "", why),
                              kRejoinDelay);
}

}  // namespace

WatchStream::WatchStream(Setup setup, engine::JobManager& jobs, const DrainState& drain)
    : context_(setup.context),
      call_(std::move(setup.call)),
      snapshot_interval_(setup.snapshot_interval),
      jobs_(jobs),
      pool_(*setup.pool),
      drain_(drain),
      request_(std::move(setup.request)) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchStream::Start(
    std::shared_ptr<WatchStream> stream) {
  WatchStream* reactor = stream.get();
  reactor->self_ = stream;
  reactor->deadline_alarm_.Set(absl::ToChronoTime(reactor->call_->run().deadline),
                               [weak = std::weak_ptr(stream)](bool expired) {
                                 if (auto self = weak.lock(); self && expired) self->Expire();
                               });
  std::lock_guard lock(reactor->mutex_);
  reactor->SetTick(absl::Now() + reactor->snapshot_interval_);
  reactor->Advance();
  return reactor;
}

void WatchStream::Wake() {
  std::lock_guard lock(mutex_);
  news_ = true;
  if (drain_.ending) {
    Stop(JoinAgain("SHUTTING_DOWN", "this server is shutting down: join again, at another one"));
  }
  Advance();
}

void WatchStream::SetTick(absl::Time time) {
  tick_ = std::make_unique<grpc::Alarm>();
  tick_->Set(absl::ToChronoTime(time), [weak = weak_from_this()](bool ok) {
    if (auto self = weak.lock(); self && ok) self->Tick();
  });
}

void WatchStream::Tick() {
  std::lock_guard lock(mutex_);
  if (finished_) return;
  const absl::Time now = absl::Now();
  const absl::Time due = last_write_ + snapshot_interval_;
  SetTick(due > now ? due : now + snapshot_interval_);
  // With a write under way the client has something to read already.
  if (due > now || writing_) return;
  snapshot_due_ = news_ = true;
  Advance();
}

void WatchStream::Read(bool with_snapshot) {
  StatusOr<Batch> batch = Guarded(*call_, [&]() -> StatusOr<Batch> {
    POISE_RETURN_IF_ERROR(call_->run().Check());
    return ReadBatch(with_snapshot);
  });
  std::lock_guard lock(mutex_);
  reading_ = false;
  if (!batch.ok()) {
    Stop(batch.status());
  } else if (!stop_) {
    messages_ = std::move(batch->messages);
    complete_ = batch->complete;
    if (batch->full) news_ = true;
  }
  Advance();
}

StatusOr<WatchStream::Batch> WatchStream::ReadBatch(bool with_snapshot) {
  Batch batch;
  if (job_.empty()) {
    POISE_RETURN_IF_ERROR(Join(batch));
  } else if (with_snapshot) {
    POISE_RETURN_IF_ERROR(AddSnapshot(batch));
  }
  POISE_ASSIGN_OR_RETURN(const std::vector<api::JobEvent> events,
                         jobs_.ReadEvents(job_, last_seq_, kBatch));
  for (const api::JobEvent& event : events) {
    v1::WatchJobResponse message;
    *message.mutable_event() = convert::ToProto(event);
    batch.messages.push_back(Serialize(message));
    last_seq_ = event.seq;
    if (event.state && api::IsTerminal(*event.state)) batch.complete = true;
  }
  batch.full = events.size() == kBatch;
  // Who joined with the terminal event's number has seen it.
  if (terminal_ && !batch.full) batch.complete = true;
  return batch;
}

Status WatchStream::Join(Batch& batch) {
  POISE_ASSIGN_OR_RETURN(const v1::WatchJobRequest request,
                         Parse<v1::WatchJobRequest>(std::move(request_)));
  POISE_ASSIGN_OR_RETURN(job_, convert::JobId(request.name()));
  subscription_ = jobs_.news().Subscribe(job_, [weak = weak_from_this()] {
    if (auto self = weak.lock()) self->Wake();
  });
  last_seq_ = std::max<int64_t>(request.after_seq(), 0);
  return AddSnapshot(batch);
}

Status WatchStream::AddSnapshot(Batch& batch) {
  POISE_ASSIGN_OR_RETURN(const api::Job job, jobs_.Get(call_->tenant(), job_));
  terminal_ = api::IsTerminal(job.state);
  // A store that was restored from a backup is behind its clients.
  last_seq_ = std::min(last_seq_, job.event_seq);
  v1::WatchJobResponse message;
  *message.mutable_snapshot() = convert::ToProto(job);
  batch.messages.push_back(Serialize(message));
  return absl::OkStatus();
}

void WatchStream::OnWriteDone(bool ok) {
  std::lock_guard lock(mutex_);
  writing_ = false;
  last_write_ = absl::Now();
  messages_.pop_front();
  if (!ok) {
    Stop(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the client is gone"));
  }
  Advance();
}

void WatchStream::OnCancel() {
  call_->Cancel();
  std::lock_guard lock(mutex_);
  Stop(base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "",
                       "the caller cancelled the call, or its deadline passed"));
  Advance();
}

Status WatchStream::ExpiryStatus() const {
  if (context_->deadline() <= absl::ToChronoTime(absl::Now())) {
    return base::MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
                           "the deadline passed before the job ended");
  }
  return JoinAgain("WATCH_EXPIRED", "a watch does not last longer: join again");
}

void WatchStream::Expire() {
  std::lock_guard lock(mutex_);
  if (finished_) return;
  call_->Cancel();
  Stop(ExpiryStatus());
  Advance();
}

void WatchStream::Cut() {
  {
    std::lock_guard lock(mutex_);
    if (finished_ || !writing_) return;
    cutting_ = true;
  }
  // The client does not read: only a cancelled stream gives the pending write back.
  context_->TryCancel();
  std::lock_guard lock(mutex_);
  cutting_ = false;
  Advance();
}

void WatchStream::OnDone() {
  deadline_alarm_.Cancel();
  cut_alarm_.Cancel();
  {
    std::lock_guard lock(mutex_);
    tick_.reset();
  }
  self_.reset();
}

void WatchStream::Stop(Status status) {
  if (stop_ || finished_) return;
  stop_ = std::move(status);
  // What a write uses stays until OnWriteDone.
  if (!messages_.empty()) {
    messages_.erase(writing_ ? std::next(messages_.begin()) : messages_.begin(), messages_.end());
  }
  if (!writing_) return;
  // A client that reads takes the message under way and then learns why the stream ends.
  cut_alarm_.Set(absl::ToChronoTime(absl::Now() + kLastWrite),
                 [weak = weak_from_this()](bool expired) {
                   if (auto self = weak.lock(); self && expired) self->Cut();
                 });
}

void WatchStream::Advance() {
  if (finished_ || writing_ || reading_ || cutting_) return;
  if (!messages_.empty()) {
    writing_ = true;
    StartWrite(&messages_.front());
  } else if (stop_ || complete_) {
    finished_ = true;
    Finish(convert::ToGrpc(stop_.value_or(absl::OkStatus())));
  } else if (news_) {
    BeginRead();
  }
}

void WatchStream::BeginRead() {
  reading_ = true;
  news_ = false;
  pool_.Submit([self = shared_from_this(), with_snapshot = std::exchange(snapshot_due_, false)] {
    self->Read(with_snapshot);
  });
}

}  // namespace poise::server
