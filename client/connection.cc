#include "client/connection.h"

#include <algorithm>

#include "absl/time/clock.h"
#include "client/transport_error.h"

namespace poise::client {
namespace {

constexpr int kMaxMessageBytes = 64 << 20;  // the server's limit too
// Above the shortest ping interval that the server allows (20 s), with room for jitter.
constexpr int kKeepaliveMs = 60'000;

std::shared_ptr<grpc::Channel> MakeChannel(const ClientOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  arguments.SetMaxSendMessageSize(kMaxMessageBytes);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  // A proxy for the web (http_proxy) cannot reach this machine's own ports.
  if (IsLoopback(options.server)) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return grpc::CreateCustomChannel(options.server, grpc::InsecureChannelCredentials(), arguments);
}

}  // namespace

Connection::Connection(ClientOptions options)
    : options_(std::move(options)),
      channel_(MakeChannel(options_)),
      augmentation_(v1::AugmentationService::NewStub(channel_)),
      artifact_(v1::ArtifactService::NewStub(channel_)),
      job_(v1::JobService::NewStub(channel_)),
      worker_(v1::WorkerService::NewStub(channel_)),
      admin_(v1::AdminService::NewStub(channel_)),
      health_(grpc::health::v1::Health::NewStub(channel_)) {}

std::unique_ptr<grpc::ClientContext> Connection::NewCall(absl::Duration timeout) const {
  auto context = std::make_unique<grpc::ClientContext>();
  if (!options_.token.empty()) {
    context->AddMetadata("authorization", "Bearer " + options_.token);
  }
  timeout = std::min(timeout, options_.timeout);
  if (timeout < absl::InfiniteDuration()) {
    context->set_deadline(absl::ToChronoTime(absl::Now() + timeout));
  }
  return context;
}

}  // namespace poise::client
