#ifndef POISE_CLIENT_PUSH_CALL_H_
#define POISE_CLIENT_PUSH_CALL_H_

#include <memory>
#include <optional>

#include "client/connection.h"
#include "client/push_stream.h"

namespace poise::client {

/// The gRPC side of a PushStream.
class PushStream::Call {
 public:
  Call(const Connection& connection, const v1::PushForecastRequest& request)
      : connection_(connection),
        context_(connection.NewCall()),
        reader_(connection.push().Forecast(context_.get(), request)) {}

  const Connection& connection_;
  std::unique_ptr<grpc::ClientContext> context_;
  std::unique_ptr<grpc::ClientReader<v1::PushForecastResponse>> reader_;
  std::optional<Status> outcome_;  // once the stream has ended
};

}  // namespace poise::client

#endif  // POISE_CLIENT_PUSH_CALL_H_
