#ifndef POISE_SERVER_HANDLERS_WATCH_STREAM_H_
#define POISE_SERVER_HANDLERS_WATCH_STREAM_H_

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "absl/time/clock.h"
#include "core/base/thread_pool.h"
#include "core/engine/job_manager.h"
#include "server/admission/admission.h"
#include "server/handlers/drain_state.h"

namespace poise::server {

/// A client that watches a job: first the job as it is, then its events in order, the terminal one
/// last; the job again when nothing happened for a while. Events are read a few at a time when the
/// last one is written, so a reader that stands still costs a fixed amount of memory and no thread.
/// Ends with kUnavailable WATCH_EXPIRED or SHUTTING_DOWN when the client is to join again.
/// Lifetime: as MessageStream.
class WatchStream : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                    public std::enable_shared_from_this<WatchStream> {
 public:
  struct Setup {
    grpc::CallbackServerContext* context;
    std::unique_ptr<Call> call;
    grpc::ByteBuffer request;
    base::ThreadPool* pool;
    absl::Duration snapshot_interval;  ///< [> 0] of a job to which nothing happens
  };
  WatchStream(Setup setup, engine::JobManager& jobs, const DrainState& drain);

  static grpc::ServerWriteReactor<grpc::ByteBuffer>* Start(std::shared_ptr<WatchStream> stream);

 private:
  static constexpr int kBatch = 16;  // events in memory
  // How long past its end a client may take to read the message under way.
  static constexpr absl::Duration kLastWrite = absl::Milliseconds(500);

  struct Batch {
    std::deque<grpc::ByteBuffer> messages;
    bool complete = false;  ///< nothing comes after them
    bool full = false;      ///< there may be more already
  };

  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

  void Wake();
  void Tick();
  void Expire();
  void Cut();
  Status ExpiryStatus() const;

  // On the pool, one at a time.
  void Read(bool with_snapshot);
  StatusOr<Batch> ReadBatch(bool with_snapshot);
  Status Join(Batch& batch);
  Status AddSnapshot(Batch& batch);

  // With mutex_ held.
  void Advance();
  void BeginRead();
  void Stop(Status status);
  void SetTick(absl::Time time);

  grpc::CallbackServerContext* const context_;
  const std::unique_ptr<Call> call_;
  const absl::Duration snapshot_interval_;
  engine::JobManager& jobs_;
  base::ThreadPool& pool_;
  const DrainState& drain_;
  grpc::Alarm deadline_alarm_;
  grpc::Alarm cut_alarm_;
  std::shared_ptr<WatchStream> self_;

  // Of the reading task.
  grpc::ByteBuffer request_;
  std::string job_;  // id; empty before the first read
  int64_t last_seq_ = 0;
  bool terminal_ = false;  // the last snapshot was
  std::unique_ptr<engine::EventHub::Subscription> subscription_;

  std::mutex mutex_;
  std::unique_ptr<grpc::Alarm> tick_;  // one for each tick: an alarm cannot set itself again
  std::deque<grpc::ByteBuffer> messages_;
  bool news_ = true;  // since the last read began
  bool snapshot_due_ = false;
  absl::Time last_write_ = absl::Now();
  bool reading_ = false;
  bool writing_ = false;
  bool cutting_ = false;  // keeps the context until TryCancel is back
  bool complete_ = false;
  bool finished_ = false;
  std::optional<Status> stop_;  // why the stream ends early
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_WATCH_STREAM_H_
