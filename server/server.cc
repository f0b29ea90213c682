#include "server/server.h"

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/server_builder.h>

#include <utility>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "server/interceptors/request_log.h"

namespace poise::server {
namespace {

constexpr int kMaxStreamsPerConnection = 256;
constexpr int kKeepaliveMs = 60'000;         // asks a silent client whether it is still there
constexpr int kKeepaliveTimeoutMs = 20'000;  // and takes it for dead after this
constexpr int kMinClientPingMs = 20'000;     // clients may ask that often
constexpr int kConnectionAgeMs = 300'000;    // then new calls spread over the servers again
constexpr int kMaxSynchronousThreads = 32;   // reflection, the one service of the synchronous kind

// Connections are told to go after kConnectionAgeMs, but a stream may live as long as its method
// allows: cutting it after minutes would make an all-night Augment impossible.
int ConnectionGraceMs(const MethodPolicies& methods) {
  return static_cast<int>(absl::ToInt64Milliseconds(methods.longest()));
}

void SetChannelArguments(const ServerConfig& config, grpc::ServerBuilder& builder) {
  // Two servers on one port would both seem to work.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, kMaxStreamsPerConnection);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             kMinClientPingMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, kConnectionAgeMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_GRACE_MS,
                             ConnectionGraceMs(config.methods));
  // A client may send as much as a pending read wants, and no more ahead: of a broken upload little
  // is on its way, and a server that is busy does not fill its memory.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  builder.SetMaxReceiveMessageSize(config.max_message_bytes);
  builder.SetMaxSendMessageSize(config.max_message_bytes);
  grpc::ResourceQuota quota("poised");
  quota.Resize(config.max_transport_bytes).SetMaxThreads(kMaxSynchronousThreads);
  builder.SetResourceQuota(quota);
  builder.SetSyncServerOption(grpc::ServerBuilder::NUM_CQS, 1);
  builder.SetSyncServerOption(grpc::ServerBuilder::MIN_POLLERS, 1);
  builder.SetSyncServerOption(grpc::ServerBuilder::MAX_POLLERS, 1);
}

}  // namespace

StatusOr<std::unique_ptr<Server>> Server::Start(const ServerConfig& config, engine::Engine& engine,
                                                base::Telemetry& telemetry) {
  // Debian's Abseil looks for deadlocks in a graph of all locks, at each lock that gRPC takes: a
  // tenth of the time of a small call.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  auto server = std::unique_ptr<Server>(new Server(config, engine, telemetry));
  POISE_RETURN_IF_ERROR(server->Listen(config, telemetry));
  return server;
}

Server::Server(const ServerConfig& config, engine::Engine& engine, base::Telemetry& telemetry)
    : job_manager_(engine.jobs()),
      admission_(config.admission, telemetry),
      store_calls_(config.store_threads),
      augmentation_(engine, admission_, config.methods.augment, telemetry),
      prediction_(engine, admission_, config.methods),
      push_(engine, admission_, config.methods.push, telemetry),
      artifacts_(engine.artifacts(), admission_, config.methods),
      models_(engine.models(), admission_, config.methods),
      data_(engine.data_sets(), admission_, config.methods),
      jobs_(engine.jobs(), engine.artifacts(), store_calls_, admission_, config.methods, drain_,
            config.snapshot_interval),
      operations_(engine.jobs(), store_calls_, admission_, config.methods, drain_),
      workers_(engine.jobs(), store_calls_, admission_, config.methods.worker, drain_),
      admin_(engine.jobs(), admission_, config.methods.admin) {}

Server::~Server() {
  if (server_) Shutdown(absl::InfinitePast());
}

Status Server::Listen(const ServerConfig& config, base::Telemetry& telemetry) {
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  SetChannelArguments(config, builder);
  int port = 0;
  builder.AddListeningPort(config.listen, grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&augmentation_);
  builder.RegisterService(&prediction_);
  builder.RegisterService(&push_);
  builder.RegisterService(&artifacts_);
  builder.RegisterService(&models_);
  builder.RegisterService(&data_);
  builder.RegisterService(&jobs_);
  builder.RegisterService(&operations_);
  builder.RegisterService(&workers_);
  builder.RegisterService(&admin_);
  builder.RegisterCallbackGenericService(&unknown_method_);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(std::make_unique<RequestLogFactory>(telemetry));
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || port == 0) {
    server_ = nullptr;
    return base::FailedPrecondition(
        "CANNOT_LISTEN", "listen",
        fmt::format("cannot listen on {}: another program has the port, or the address is not "
                    "this machine's",
                    config.listen));
  }
  address_ = fmt::format("{}:{}", config.listen.substr(0, config.listen.rfind(':')), port);
  for (const char* service :
       {v1::AugmentationService::service_full_name(), v1::PredictionService::service_full_name(),
        v1::ArtifactService::service_full_name(), v1::ModelService::service_full_name(),
        v1::DataService::service_full_name(), v1::JobService::service_full_name(),
        v1::WorkerService::service_full_name(), v1::AdminService::service_full_name(),
        v1::PushService::service_full_name(),
        google::longrunning::Operations::service_full_name()}) {
    server_->GetHealthCheckService()->SetServingStatus(service, true);
  }
  return absl::OkStatus();
}

void Server::AnnounceShutdown() {
  server_->GetHealthCheckService()->SetServingStatus(false);
  drain_.announced = true;
  job_manager_.lease_waiters().WakeAll();
}

void Server::Shutdown(absl::Time deadline) {
  admission_.Close();
  drain_.ending = true;
  job_manager_.lease_waiters().WakeAll();
  job_manager_.news().PublishToAll();
  job_manager_.transitions().PublishToAll();
  server_->Shutdown(absl::ToChronoTime(deadline));
  admission_.WaitUntilIdle();
}

}  // namespace poise::server
