#ifndef POISE_TESTS_SUPPORT_TEST_SERVER_H_
#define POISE_TESTS_SUPPORT_TEST_SERVER_H_

#include <grpcpp/channel.h>

#include <memory>
#include <string>
#include <vector>

#include "core/engine/engine.h"
#include "poise/v1/artifact_service.grpc.pb.h"
#include "poise/v1/augmentation_service.grpc.pb.h"
#include "server/server.h"
#include "server/telemetry/prometheus_telemetry.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// A server in this process, on a free port, with a data folder of its own.
class TestServer {
 public:
  explicit TestServer(server::ServerConfig config = {}, int compute_threads = 2);
  TestServer(server::ServerConfig config, int compute_threads,
             const engine::JobManagerConfig& jobs);
  /// The data folder of `engine` is this server's own.
  TestServer(server::ServerConfig config, engine::EngineConfig engine);

  /// A connection of its own, not shared with other channels.
  std::shared_ptr<grpc::Channel> NewChannel() const;
  std::shared_ptr<grpc::Channel> channel() const { return channel_; }

  server::Server& server() { return *server_; }
  engine::Engine& engine() { return *engine_; }
  const std::filesystem::path& folder() const { return folder_.path(); }
  server::PrometheusTelemetry& telemetry() { return telemetry_; }

 private:
  TemporaryFolder folder_;
  server::PrometheusTelemetry telemetry_;
  std::unique_ptr<engine::Engine> engine_;
  std::unique_ptr<server::Server> server_;
  std::shared_ptr<grpc::Channel> channel_;
};

/// A connection of its own to ADDR:PORT.
std::shared_ptr<grpc::Channel> ConnectTo(const std::string& address);

/// A request for variants of a small swinging biped.
v1::AugmentRequest SwingRequest(int frames, int variants, uint64_t seed = 1);

/// All variants of a request as bytes, in the order in which they came; the status in *status.
std::vector<std::string> ReadVariants(const std::shared_ptr<grpc::Channel>& channel,
                                      const v1::AugmentRequest& request, grpc::Status* status);

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_TEST_SERVER_H_
