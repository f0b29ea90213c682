#ifndef POISE_TESTS_SUPPORT_FAKE_WORKER_H_
#define POISE_TESTS_SUPPORT_FAKE_WORKER_H_

#include <grpcpp/channel.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "core/base/status.h"
#include "poise/v1/worker_service.grpc.pb.h"

namespace poise::testing {

/// Says to a server what a worker says, and does no work.
class FakeWorker {
 public:
  /// Registers at once.
  explicit FakeWorker(const std::shared_ptr<grpc::Channel>& channel, std::string id = "worker-1");

  /// A lease, or none within `wait`. Every call has a new token unless one is given.
  StatusOr<v1::LeaseJobResponse> Lease(absl::Duration wait = absl::ZeroDuration(),
                                       v1::LeaseJobRequest request = {}) const;
  /// The same, and there must be one.
  v1::Lease MustLease(absl::Duration wait = absl::ZeroDuration()) const;
  StatusOr<v1::HeartbeatResponse> Heartbeat(const v1::Lease& lease, int64_t step = 0,
                                            absl::Duration hold = absl::ZeroDuration()) const;
  Status Checkpoint(const v1::Lease& lease, const std::string& artifact, int64_t step) const;
  /// Of `finish` the fence is filled in.
  StatusOr<v1::FinishJobResponse> Finish(const v1::Lease& lease,
                                         v1::FinishJobRequest finish = {}) const;
  StatusOr<v1::FinishJobResponse> Fail(const v1::Lease& lease, absl::StatusCode code) const;
  Status Release(const v1::Lease& lease) const;

  v1::WorkerService::Stub& stub() const { return *stub_; }

 private:
  const std::string id_;
  std::unique_ptr<v1::WorkerService::Stub> stub_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_SUPPORT_FAKE_WORKER_H_
