#include "client/job_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "client/job_watch_stream.h"
#include "proto/convert/job_convert.h"

namespace poise::client {
namespace {

// So soon a watch notices its Cancel while the server is gone.
constexpr absl::Duration kLongestPause = absl::Milliseconds(100);

Status Cancelled() {
  return base::MakeError(absl::StatusCode::kCancelled, "CANCELLED", "", "the watch was cancelled");
}

}  // namespace

JobWatch::JobWatch(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}
JobWatch::~JobWatch() = default;
StatusOr<std::optional<api::JobEvent>> JobWatch::Next() { return stream_->Next(); }
const api::Job& JobWatch::job() const { return stream_->job(); }
int64_t JobWatch::last_seq() const { return stream_->last_seq(); }
void JobWatch::Cancel() { stream_->Cancel(); }

JobWatch::Stream::Stream(const Connection& connection, std::string id, const WatchOptions& options)
    : connection_(connection),
      id_(std::move(id)),
      deadline_(std::min(options.deadline, absl::Now() + connection.options().timeout)),
      backoff_({.outage = connection.options().outage}),
      last_seq_(options.after_seq) {}

JobWatch::Stream::~Stream() {
  if (reader_ == nullptr) return;
  context_->TryCancel();
  reader_->Finish();  // gRPC wants every call to be finished
}

StatusOr<std::optional<api::JobEvent>> JobWatch::Stream::Next() {
  v1::WatchJobResponse response;
  while (!outcome_) {
    if (reader_ == nullptr && !Join()) {
      outcome_ = Cancelled();
    } else if (reader_->Read(&response)) {
      POISE_ASSIGN_OR_RETURN(std::optional<api::JobEvent> event, Take(response));
      if (event) return event;
    } else if (const Status status = Break(); !status.ok()) {
      outcome_ = status;
    }
  }
  POISE_RETURN_IF_ERROR(*outcome_);
  return std::optional<api::JobEvent>();
}

void JobWatch::Stream::Cancel() {
  std::lock_guard lock(mutex_);
  cancelled_ = true;
  if (context_ != nullptr) context_->TryCancel();
}

bool JobWatch::Stream::Join() {
  v1::WatchJobRequest request;
  request.set_name(convert::JobName(id_));
  request.set_after_seq(last_seq_);
  std::lock_guard lock(mutex_);
  if (cancelled_) return false;
  joined_ = false;
  context_ = connection_.NewCall(deadline_ - absl::Now());
  reader_ = connection_.job().WatchJob(context_.get(), request);
  return true;
}

Status JobWatch::Stream::Break() {
  Status status = connection_.Explain(reader_->Finish());
  {
    std::lock_guard lock(mutex_);
    reader_.reset();
    context_.reset();
    if (cancelled_) return Cancelled();
  }
  if (absl::Now() >= deadline_) {
    return base::MakeError(absl::StatusCode::kDeadlineExceeded, "DEADLINE_EXCEEDED", "",
                           fmt::format("{} has not ended in time", convert::JobName(id_)));
  }
  // A server ends a stream before the job's end when it stops, and a proxy or a limit of the
  // server's may do so at any time.
  const bool cut = status.ok() || status.code() == absl::StatusCode::kCancelled ||
                   status.code() == absl::StatusCode::kDeadlineExceeded;
  if (cut) {
    status = base::MakeError(absl::StatusCode::kUnavailable, "CONNECTION_LOST", "server",
                             "the stream of events ended before the job did");
  }
  const std::optional<absl::Duration> delay = backoff_.Next(status);
  if (!delay) return status;
  return Wait(std::min(*delay, deadline_ - absl::Now()));
}

Status JobWatch::Stream::Wait(absl::Duration delay) {
  const absl::Time end = absl::Now() + delay;
  for (bool connected = false; !connected && absl::Now() < end;) {
    connected = connection_.Pause(std::min(kLongestPause, end - absl::Now()));
    std::lock_guard lock(mutex_);
    if (cancelled_) return Cancelled();
  }
  return absl::OkStatus();
}

StatusOr<std::optional<api::JobEvent>> JobWatch::Stream::Take(
    const v1::WatchJobResponse& response) {
  backoff_.NoteAnswer();
  if (response.has_snapshot()) {
    POISE_ASSIGN_OR_RETURN(api::Job job, convert::FromProto(response.snapshot()));
    TakeSnapshot(std::move(job));
    return std::optional<api::JobEvent>();
  }
  if (!response.has_event()) return std::optional<api::JobEvent>();  // of a newer server
  POISE_ASSIGN_OR_RETURN(api::JobEvent event, convert::FromProto(response.event()));
  if (event.seq <= last_seq_) return std::optional<api::JobEvent>();
  backoff_.NoteProgress();
  last_seq_ = event.seq;
  Apply(event);
  if (event.state && api::IsTerminal(*event.state)) outcome_ = absl::OkStatus();
  return std::optional<api::JobEvent>(std::move(event));
}

void JobWatch::Stream::TakeSnapshot(api::Job job) {
  // The second one of a stream comes when it has lived long.
  if (std::exchange(joined_, true)) backoff_.NoteProgress();
  // Its terminal event was given already, before this watch or by it.
  if (api::IsTerminal(job.state) && job.event_seq <= last_seq_) outcome_ = absl::OkStatus();
  if (job.event_seq >= job_.event_seq) job_ = std::move(job);
}

void JobWatch::Stream::Apply(const api::JobEvent& event) {
  if (event.seq <= job_.event_seq) return;  // the snapshot was newer
  job_.event_seq = event.seq;
  job_.attempt = event.attempt;
  if (event.state) {
    job_.state = *event.state;
    job_.error = event.error;
    if (api::IsTerminal(job_.state)) job_.end_time = event.time;
  }
  if (event.progress) job_.progress = *event.progress;
  if (event.checkpoint) job_.checkpoint = event.checkpoint;
}

}  // namespace poise::client
