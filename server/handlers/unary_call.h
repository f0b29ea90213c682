#ifndef POISE_SERVER_HANDLERS_UNARY_CALL_H_
#define POISE_SERVER_HANDLERS_UNARY_CALL_H_

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <optional>

#include "core/base/status.h"
#include "core/base/thread_pool.h"
#include "server/admission/admission.h"

namespace poise::server {

/// A call with one answer that may have to be waited for. Try runs on a pool; while it has no
/// answer the call waits, without a thread, and Try runs again after each Wake. At the deadline,
/// and when the client is gone, the call ends at once; what runs then runs to its end for nobody.
/// Lifetime: as MessageStream.
class UnaryCall : public grpc::ServerUnaryReactor, public std::enable_shared_from_this<UnaryCall> {
 public:
  struct Setup {
    grpc::CallbackServerContext* context;
    std::unique_ptr<Call> call;
    base::ThreadPool* pool;
    grpc::ByteBuffer* response;
  };

  /// Begins the work; returns what a handler returns to gRPC.
  static grpc::ServerUnaryReactor* Start(std::shared_ptr<UnaryCall> call);

  /// There may be an answer now. Quick; threads: any.
  void Wake();

 protected:
  /// nullopt: none yet.
  using Answer = StatusOr<std::optional<grpc::ByteBuffer>>;

  explicit UnaryCall(Setup setup);

  /// One run at a time. A Wake during the run leads to another one, so a subscription that was
  /// there before the run misses nothing.
  virtual Answer Try() = 0;
  /// Called once, when the call has ended and Try will not run again: for what must not be held
  /// longer.
  virtual void OnEnded() {}

  /// Wakes the call then; called at most once, by Try.
  void WakeAt(absl::Time time);
  const Call& call() const { return *call_; }

 private:
  enum class State { kIdle, kRunning, kRunAgain };

  void OnCancel() final;
  void OnDone() final;
  void Run();
  Answer TryNow();
  void End(const StatusOr<grpc::ByteBuffer>& answer);

  const std::unique_ptr<Call> call_;
  base::ThreadPool& pool_;
  grpc::ByteBuffer* const response_;
  grpc::Alarm deadline_alarm_;
  grpc::Alarm wake_alarm_;
  std::shared_ptr<UnaryCall> self_;

  std::mutex mutex_;
  State state_ = State::kIdle;
  bool ended_ = false;  // Finish was called
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_UNARY_CALL_H_
