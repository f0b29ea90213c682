#include "server/handlers/lease_call.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"
#include "core/base/fail_point.h"
#include "proto/convert/time_convert.h"
#include "server/handlers/wire.h"
#include "server/handlers/worker_convert.h"

namespace poise::server {

LeaseCall::LeaseCall(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
                     const DrainState& drain)
    : UnaryCall(std::move(setup)), request_(std::move(request)), jobs_(jobs), drain_(drain) {}

Status LeaseCall::Begin() {
  POISE_ASSIGN_OR_RETURN(const v1::LeaseJobRequest request,
                         Parse<v1::LeaseJobRequest>(std::move(request_)));
  POISE_ASSIGN_OR_RETURN(query_, FromProto(request));
  end_ = absl::Now() + std::min(convert::FromProto(request.wait()), kMaxWait);
  waiter_ = jobs_.lease_waiters().Join(*query_, [weak = weak_from_this()] {
    if (auto self = weak.lock()) self->Wake();
  });
  WakeAt(end_);
  return absl::OkStatus();
}

UnaryCall::Answer LeaseCall::Try() {
  if (!query_) POISE_RETURN_IF_ERROR(Begin());
  waiter_->Arm();
  v1::LeaseJobResponse response;
  if (drain_.announced || drain_.ending) {
    response.set_draining(true);
    return Serialize(response);
  }
  POISE_ASSIGN_OR_RETURN(const std::optional<jobs::Lease> lease, jobs_.Claim(*query_));
  if (lease) {
    base::FailPoint("jobs.after_claim");  // committed, not answered
    waiter_->PassOn();
    *response.mutable_lease() = ToProto(*lease);
    return Serialize(response);
  }
  if (absl::Now() >= end_) return Serialize(response);
  return std::nullopt;
}

}  // namespace poise::server
