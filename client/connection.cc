#include "client/connection.h"

#include <fmt/format.h>

#include <algorithm>

#include "absl/time/clock.h"
#include "client/channel.h"
#include "client/transport_error.h"

namespace poise::client {
Connection::Connection(ClientOptions options)
    : options_(std::move(options)),
      channel_(MakeChannel(options_)),
      augmentation_(v1::AugmentationService::NewStub(channel_)),
      prediction_(v1::PredictionService::NewStub(channel_)),
      artifact_(v1::ArtifactService::NewStub(channel_)),
      model_(v1::ModelService::NewStub(channel_)),
      data_(v1::DataService::NewStub(channel_)),
      job_(v1::JobService::NewStub(channel_)),
      push_(v1::PushService::NewStub(channel_)),
      worker_(v1::WorkerService::NewStub(channel_)),
      admin_(v1::AdminService::NewStub(channel_)),
      health_(grpc::health::v1::Health::NewStub(channel_)) {}

std::unique_ptr<grpc::ClientContext> Connection::NewCall(absl::Duration timeout) const {
  auto context = std::make_unique<grpc::ClientContext>();
  if (!options_.token.empty()) {
    context->AddMetadata("authorization", "Bearer " + options_.token);
  }
  if (!options_.tenant.empty()) context->AddMetadata("x-poise-tenant", options_.tenant);
  timeout = std::min(timeout, options_.timeout);
  if (timeout < absl::InfiniteDuration()) {
    context->set_deadline(absl::ToChronoTime(absl::Now() + timeout));
  }
  return context;
}

Status Connection::Explain(const grpc::Status& status) const {
  const bool waited_in_vain = status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED &&
                              options_.timeout >= options_.outage &&
                              channel_->GetState(false) != GRPC_CHANNEL_READY;
  if (!waited_in_vain) return ExplainCall(status, options_);
  return base::MakeError(absl::StatusCode::kUnavailable, "NO_SERVER", "server",
                         fmt::format("the server at {} went away and did not come back within {}",
                                     options_.server, absl::FormatDuration(options_.outage)));
}

bool Connection::Pause(absl::Duration time) const {
  if (channel_->GetState(true) != GRPC_CHANNEL_READY) {
    return channel_->WaitForConnected(absl::ToChronoTime(absl::Now() + time));
  }
  absl::SleepFor(time);
  return false;
}

}  // namespace poise::client
