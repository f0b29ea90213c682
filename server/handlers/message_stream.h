#ifndef POISE_SERVER_HANDLERS_MESSAGE_STREAM_H_
#define POISE_SERVER_HANDLERS_MESSAGE_STREAM_H_

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "core/base/status.h"
#include "core/base/thread_pool.h"
#include "server/admission/admission.h"

namespace poise::server {

/// A server stream of numbered messages that are made on a pool, several at a time, and written in
/// order. A message is only begun when fewer than `window` of its predecessors wait to be written
/// (and fewer bytes than kWindowBytes), so a client that reads slowly makes the work wait, and a
/// stalled stream holds a bounded amount of memory. Cancellation, a broken connection and the
/// deadline stop the work at its next RunContext::Check.
/// Lifetime: Start makes the stream own itself until gRPC says OnDone; tasks share that ownership.
class MessageStream : public grpc::ServerWriteReactor<grpc::ByteBuffer>,
                      public std::enable_shared_from_this<MessageStream> {
 public:
  struct Setup {
    grpc::CallbackServerContext* context;
    std::unique_ptr<Call> call;
    base::ThreadPool* pool;     ///< makes the messages
    base::ThreadPool* writers;  ///< gives them to gRPC, which sends at once; may be `pool`
    int window;                 ///< [> 0] messages that may be under way
  };

  /// Begins the work; returns what a handler returns to gRPC.
  static grpc::ServerWriteReactor<grpc::ByteBuffer>* Start(std::shared_ptr<MessageStream> stream);

 protected:
  explicit MessageStream(Setup setup);

  /// Number of messages. Runs once, on the pool.
  virtual StatusOr<int64_t> Prepare(const base::RunContext& context) = 0;
  /// Message `ordinal`. Runs on the pool, for several ordinals at the same time.
  virtual StatusOr<grpc::ByteBuffer> Make(int64_t ordinal, const base::RunContext& context) = 0;

  const Call& call() const { return *call_; }

 private:
  static constexpr size_t kWindowBytes = 8 << 20;
  // How long past the deadline a client may take to read the message under way.
  static constexpr absl::Duration kLastWrite = absl::Milliseconds(500);

  void OnWriteDone(bool ok) final;
  void OnCancel() final;
  void OnDone() final;

  void RunPrepare();
  void RunMake(int64_t ordinal);
  void Expire();
  void Cut();

  // With mutex_ held: begins what can begin now (messages, a write, Finish).
  void Advance();
  void BeginMessages();
  void BeginWrite();
  void Stop(Status status);

  grpc::CallbackServerContext* const context_;
  const std::unique_ptr<Call> call_;
  base::ThreadPool& pool_;
  base::ThreadPool& writers_;
  const int window_;
  grpc::Alarm deadline_alarm_;
  grpc::Alarm cut_alarm_;  // set when the deadline meets a write under way
  std::shared_ptr<MessageStream> self_;

  std::mutex mutex_;
  int64_t total_ = 0;
  int64_t begun_ = 0;    // messages given to the pool
  int64_t written_ = 0;  // messages that gRPC has taken
  int tasks_ = 0;        // that use this object; Finish waits for them
  bool prepared_ = false;
  bool writing_ = false;
  bool finished_ = false;
  std::optional<Status> stop_;  // why the stream ends early
  std::map<int64_t, StatusOr<grpc::ByteBuffer>> ready_;
  size_t message_bytes_ = 0;  // largest so far
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_MESSAGE_STREAM_H_
