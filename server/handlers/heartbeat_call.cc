#include "server/handlers/heartbeat_call.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "proto/convert/time_convert.h"
#include "server/handlers/wire.h"
#include "server/handlers/worker_convert.h"

namespace poise::server {

HeartbeatCall::HeartbeatCall(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
                             const DrainState& drain)
    : UnaryCall(std::move(setup)), request_(std::move(request)), jobs_(jobs), drain_(drain) {}

StatusOr<jobs::HeartbeatReply> HeartbeatCall::Begin() {
  POISE_ASSIGN_OR_RETURN(const v1::HeartbeatRequest request,
                         Parse<v1::HeartbeatRequest>(std::move(request_)));
  POISE_ASSIGN_OR_RETURN(fence_, FromProto(request.fence()));
  const absl::Duration hold = std::min(
      {convert::FromProto(request.hold()), kMaxHold, jobs_.config().policy.heartbeat_interval});
  end_ = absl::Now() + hold;
  if (hold > absl::ZeroDuration()) {
    subscription_ = jobs_.transitions().Subscribe(fence_->job, [weak = weak_from_this()] {
      if (auto self = weak.lock()) self->Wake();
    });
    WakeAt(end_);
  }
  std::optional<base::Progress> progress;
  if (request.has_progress()) progress = FromWorker(request.progress());
  return jobs_.Heartbeat(*fence_, progress);
}

UnaryCall::Answer HeartbeatCall::Try() {
  POISE_ASSIGN_OR_RETURN(const jobs::HeartbeatReply reply,
                         fence_ ? jobs_.Heartbeat(*fence_, std::nullopt) : Begin());
  const bool held = reply.directive == jobs::Directive::kContinue && absl::Now() < end_;
  if (held && !drain_.ending) return std::nullopt;
  return Serialize(ToProto(reply));
}

}  // namespace poise::server
