#ifndef POISE_SERVER_HANDLERS_WIRE_H_
#define POISE_SERVER_HANDLERS_WIRE_H_

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/byte_buffer.h>

#include "core/base/status.h"

/// Our methods take and give raw bytes (WithRawCallbackMethod): gRPC itself would answer bytes that
/// are no message with INTERNAL and without details.
namespace poise::server {

/// Errors: kInvalidArgument MALFORMED_REQUEST.
template <typename Message>
StatusOr<Message> Parse(grpc::ByteBuffer bytes) {
  Message message;
  const size_t size = bytes.Length();
  if (!grpc::SerializationTraits<Message>::Deserialize(&bytes, &message).ok()) {
    return base::InvalidArgument(
        "MALFORMED_REQUEST", "",
        fmt::format("these {} bytes are no {}", size, Message::descriptor()->full_name()));
  }
  return message;
}

template <typename Message>
grpc::ByteBuffer Serialize(const Message& message) {
  grpc::ByteBuffer bytes;
  bool own_buffer = false;
  grpc::SerializationTraits<Message>::Serialize(message, &bytes, &own_buffer).IgnoreError();
  return bytes;
}

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_WIRE_H_
