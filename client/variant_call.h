#ifndef POISE_CLIENT_VARIANT_CALL_H_
#define POISE_CLIENT_VARIANT_CALL_H_

#include <memory>
#include <optional>

#include "client/connection.h"
#include "client/variant_stream.h"

namespace poise::client {

/// The gRPC side of a VariantStream.
class VariantStream::Call {
 public:
  Call(const Connection& connection, const v1::AugmentRequest& request)
      : connection_(connection),
        context_(connection.NewCall()),
        reader_(connection.augmentation().Augment(context_.get(), request)) {}

  const Connection& connection_;
  std::unique_ptr<grpc::ClientContext> context_;
  std::unique_ptr<grpc::ClientReader<v1::AugmentResponse>> reader_;
  std::optional<Status> outcome_;  // once the stream has ended
};

}  // namespace poise::client

#endif  // POISE_CLIENT_VARIANT_CALL_H_
