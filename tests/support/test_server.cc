#include "tests/support/test_server.h"

#include <grpcpp/create_channel.h>

#include <atomic>
#include <cstdlib>
#include <utility>

#include "proto/convert/clip_convert.h"
#include "server/log.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

// Set-up that fails is a broken test machine: say why and end.
template <typename Value>
Value OrDie(StatusOr<Value> value) {
  if (!value.ok()) {
    std::fprintf(stderr, "test server: %s\n", base::Message(value.status()).c_str());
    std::abort();
  }
  return *std::move(value);
}

}  // namespace

TestServer::TestServer(server::ServerConfig config, int compute_threads)
    : TestServer(std::move(config), compute_threads, engine::JobManagerConfig()) {}

TestServer::TestServer(server::ServerConfig config, int compute_threads,
                       const engine::JobManagerConfig& jobs)
    : TestServer(
          std::move(config),
          engine::EngineConfig{.data_dir = {}, .compute_threads = compute_threads, .jobs = jobs}) {}

TestServer::TestServer(server::ServerConfig config, engine::EngineConfig engine) {
  server::StartLog("off").IgnoreError();
  config.listen = "127.0.0.1:0";
  engine.data_dir = folder_.path();
  engine_ = OrDie(engine::Engine::Create(engine, telemetry_));
  server_ = OrDie(server::Server::Start(config, *engine_, telemetry_));
  channel_ = NewChannel();
}

std::shared_ptr<grpc::Channel> TestServer::NewChannel() const {
  return ConnectTo(server_->address());
}

std::shared_ptr<grpc::Channel> ConnectTo(const std::string& address) {
  static std::atomic<int> number = 0;
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  arguments.SetMaxSendMessageSize(-1);
  // Channels with equal arguments would share one connection.
  arguments.SetInt("poise.test.channel", ++number);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

v1::AugmentRequest SwingRequest(int frames, int variants, uint64_t seed) {
  v1::AugmentRequest request;
  *request.add_sources()->mutable_clip() = convert::ToProto(SwingingClip(frames));
  request.set_variants_per_source(variants);
  request.set_seed(seed);
  return request;
}

std::vector<std::string> ReadVariants(const std::shared_ptr<grpc::Channel>& channel,
                                      const v1::AugmentRequest& request, grpc::Status* status) {
  const auto stub = v1::AugmentationService::NewStub(channel);
  grpc::ClientContext context;
  const auto reader = stub->Augment(&context, request);
  std::vector<std::string> variants;
  v1::AugmentResponse response;
  while (reader->Read(&response)) variants.push_back(response.SerializeAsString());
  *status = reader->Finish();
  return variants;
}

}  // namespace poise::testing
