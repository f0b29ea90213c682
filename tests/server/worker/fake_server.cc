#include "tests/server/worker/fake_server.h"

#include <grpcpp/server_builder.h>

#include <string>

#include "proto/convert/status_convert.h"
#include "proto/convert/time_convert.h"

namespace poise::testing {

FakeServer::FakeServer() {
  int port = 0;
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(this);
  server_ = builder.BuildAndStart();
  client::ClientOptions options;
  options.server = "127.0.0.1:" + std::to_string(port);
  client_ = std::make_unique<worker::WorkerClient>(options);
}

FakeServer::~FakeServer() {
  Set([this] { ending_ = true; });
  server_->Shutdown(std::chrono::system_clock::now());
}

jobs::Lease FakeServer::lease(absl::Duration expires_in) const {
  jobs::Lease lease;
  lease.fence = {.job = "0123456789ab-cdef", .attempt = 1, .token = "token"};
  lease.expires_in = expires_in;
  return lease;
}

grpc::Status FakeServer::Heartbeat(grpc::ServerContext* context,
                                   const v1::HeartbeatRequest* request,
                                   v1::HeartbeatResponse* response) {
  std::unique_lock lock(mutex_);
  if (request->has_progress()) steps_.push_back(request->progress().step());
  const absl::Duration hold = convert::FromProto(request->hold());
  if (hold > absl::ZeroDuration()) ++held_;
  const auto end = std::chrono::steady_clock::now() + absl::ToChronoNanoseconds(hold);
  while (!ending_ && !context->IsCancelled() &&
         (silent_ || (!cancel_ && !lost_ && std::chrono::steady_clock::now() < end))) {
    changed_.wait_for(lock, std::chrono::milliseconds(10));
  }
  if (lost_) {
    return convert::ToGrpc(
        base::MakeError(absl::StatusCode::kAborted, "LEASE_LOST", "", "another has it"));
  }
  response->set_directive(cancel_ ? v1::HeartbeatResponse::CANCEL
                                  : v1::HeartbeatResponse::CONTINUE);
  *response->mutable_expires_in() = convert::ToProto(absl::Seconds(30));
  return grpc::Status::OK;
}

std::vector<int64_t> FakeServer::steps() const {
  std::lock_guard lock(mutex_);
  return steps_;
}

int FakeServer::held() const {
  std::lock_guard lock(mutex_);
  return held_;
}

}  // namespace poise::testing
