#ifndef POISE_SERVER_HANDLERS_LEASE_CALL_H_
#define POISE_SERVER_HANDLERS_LEASE_CALL_H_

#include <memory>
#include <optional>

#include "core/engine/job_manager.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/unary_call.h"

namespace poise::server {

/// A worker's long poll for a job.
class LeaseCall : public UnaryCall {
 public:
  /// [s] A longer wait is cut to this; the worker asks again.
  static constexpr absl::Duration kMaxWait = absl::Seconds(30);

  LeaseCall(Setup setup, grpc::ByteBuffer request, engine::JobManager& jobs,
            const DrainState& drain);

 private:
  Answer Try() override;
  void OnEnded() override { waiter_.reset(); }
  Status Begin();

  grpc::ByteBuffer request_;
  engine::JobManager& jobs_;
  const DrainState& drain_;
  std::optional<jobs::ClaimQuery> query_;
  std::unique_ptr<engine::LeaseWaiters::Waiter> waiter_;
  absl::Time end_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_LEASE_CALL_H_
