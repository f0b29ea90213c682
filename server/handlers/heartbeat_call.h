#ifndef POISE_SERVER_HANDLERS_HEARTBEAT_CALL_H_
#define POISE_SERVER_HANDLERS_HEARTBEAT_CALL_H_

#include <memory>
#include <optional>

#include "core/engine/job_manager.h"
#include "poise/v1/worker_service.pb.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/unary_call.h"

namespace poise::server {

/// A worker's sign of life: takes the lease further at once, then holds the answer until there is
/// a wish to cancel, the lease is lost, or the hold is over; then takes it further again.
class HeartbeatCall : public UnaryCall {
 public:
  /// A longer hold is cut to this, and to the heartbeat interval.
  static constexpr absl::Duration kMaxHold = absl::Seconds(30);

  HeartbeatCall(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
                const DrainState& drain);

 private:
  Answer Try() override;
  void OnEnded() override { subscription_.reset(); }
  StatusOr<jobs::HeartbeatReply> Begin();

  grpc::ByteBuffer request_;
  engine::JobManager& jobs_;
  const DrainState& drain_;
  std::optional<jobs::Fence> fence_;
  std::unique_ptr<engine::EventHub::Subscription> subscription_;
  absl::Time end_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_HEARTBEAT_CALL_H_
