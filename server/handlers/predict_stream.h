#ifndef POISE_SERVER_HANDLERS_PREDICT_STREAM_H_
#define POISE_SERVER_HANDLERS_PREDICT_STREAM_H_

#include <grpcpp/alarm.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <memory>
#include <mutex>
#include <optional>

#include "core/engine/forecaster.h"
#include "poise/v1/prediction.pb.h"
#include "server/admission/admission.h"

namespace poise::server {

/// Frames in, a forecast out after each message of frames. One message is under way at a time: the
/// next is read when the answer to the last has been handed to gRPC, so a stream takes one window
/// of frames and one answer of memory. Lifetime: as MessageStream.
class PredictStream : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      public std::enable_shared_from_this<PredictStream> {
 public:
  using Reactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  PredictStream(grpc::CallbackServerContext* context, std::unique_ptr<Call> call,
                engine::Forecaster& forecaster);

  static Reactor* Start(std::shared_ptr<PredictStream> stream);

 private:
  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override { call_->Cancel(); }
  void OnDone() override;

  /// What to answer to the message in `request_`, if anything.
  StatusOr<std::optional<grpc::ByteBuffer>> Answer();
  Status Open(const v1::PredictStreamSetup& setup);
  void End(const Status& status);
  void Expire();

  grpc::CallbackServerContext* const context_;
  const std::unique_ptr<Call> call_;
  engine::Forecaster& forecaster_;
  grpc::Alarm deadline_alarm_;
  std::shared_ptr<PredictStream> self_;

  // One callback at a time uses these: a read, the task that follows it, a write.
  grpc::ByteBuffer request_;
  grpc::ByteBuffer response_;
  motion::SkeletonPtr skeleton_;
  double frame_rate_ = 0;
  std::optional<engine::ForecastStream> stream_;
  bool described_ = false;  // model and frame times have been sent

  std::mutex mutex_;
  bool ended_ = false;  // Finish was called: the context may go away
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_PREDICT_STREAM_H_
