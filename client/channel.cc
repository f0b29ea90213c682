#include "client/channel.h"

#include <fmt/format.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "client/transport_error.h"
#include "core/base/json.h"

namespace poise::client {
namespace {

using base::Json;

constexpr int kMaxMessageBytes = 64 << 20;  // the server's limit too
// Above the shortest ping interval that the server allows (20 s), with room for jitter.
constexpr int kKeepaliveMs = 60'000;
// A server that restarts is found soon, one that is gone is not hammered.
constexpr int kFirstReconnectMs = 100;
constexpr int kLongestReconnectMs = 1'000;
constexpr int kResolveAgainMs = 1'000;

// CANCELLED too: what reaches gRPC 1.51 between its farewell (GOAWAY) and the client's reading of
// it is dropped with that code. A call that its caller cancelled is not made again.
Json RetryPolicy() {
  return {{"maxAttempts", 5},
          {"initialBackoff", "0.5s"},
          {"maxBackoff", "5s"},
          {"backoffMultiplier", 2},
          {"retryableStatusCodes", {"UNAVAILABLE", "CANCELLED"}}};
}

Json Method(const char* service, const char* method) {
  return {{"service", service}, {"method", method}};
}

// Unary calls that are the same once or twice. DeleteJob is not: the second one finds no job.
Json RepeatableMethods() {
  Json methods = Json::array();
  for (const char* method : {"CreateJob", "GetJob", "ListJobs", "CancelJob", "RetryJob"}) {
    methods.push_back(Method("poise.v1.JobService", method));
  }
  methods.push_back(Method("poise.v1.ArtifactService", "GetUpload"));
  return methods;
}

Json ServiceConfig(const ClientOptions& options) {
  Json repeatable = {
      {"name", RepeatableMethods()}, {"waitForReady", true}, {"retryPolicy", RetryPolicy()}};
  if (options.outage < absl::InfiniteDuration()) {
    repeatable["timeout"] = fmt::format("{:.3f}s", absl::ToDoubleSeconds(options.outage));
  }
  // The start of a stream of variants may be repeated too. It takes no time limit: the stream may
  // run all night.
  const Json augment = {{"name", {Method("poise.v1.AugmentationService", "Augment")}},
                        {"retryPolicy", RetryPolicy()}};
  Json config = {{"methodConfig", {repeatable, augment}}};
  if (options.server.find(',') != std::string::npos) {
    config["loadBalancingConfig"] = Json::array({{{"round_robin", Json::object()}}});
  }
  return config;
}

}  // namespace

std::string ChannelTarget(const std::string& server) {
  const bool is_list = server.find(',') != std::string::npos;
  const bool has_scheme =
      server.starts_with("ipv4:") || server.starts_with("ipv6:") || server.starts_with("dns:");
  if (!is_list || has_scheme) return server;
  return (server.starts_with('[') ? "ipv6:" : "ipv4:") + server;
}

std::shared_ptr<grpc::Channel> MakeChannel(const ClientOptions& options) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  arguments.SetMaxSendMessageSize(kMaxMessageBytes);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstReconnectMs);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kLongestReconnectMs);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS,
                   static_cast<int>(absl::ToInt64Milliseconds(options.connect_timeout)));
  arguments.SetInt(GRPC_ARG_DNS_MIN_TIME_BETWEEN_RESOLUTIONS_MS, kResolveAgainMs);
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 1);
  arguments.SetServiceConfigJSON(ServiceConfig(options).dump());
  // A proxy for the web (http_proxy) cannot reach this machine's own ports.
  if (IsLoopback(options.server)) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return grpc::CreateCustomChannel(ChannelTarget(options.server),
                                   grpc::InsecureChannelCredentials(), arguments);
}

}  // namespace poise::client
