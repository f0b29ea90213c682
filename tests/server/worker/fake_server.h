#ifndef POISE_TESTS_SERVER_WORKER_FAKE_SERVER_H_
#define POISE_TESTS_SERVER_WORKER_FAKE_SERVER_H_

#include <grpcpp/server.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "poise/v1/worker_service.grpc.pb.h"
#include "server/worker/worker_client.h"

namespace poise::testing {

/// Answers heartbeats as a test wants it.
class FakeServer : public v1::WorkerService::Service {
 public:
  FakeServer();
  ~FakeServer() override;

  worker::WorkerClient& client() { return *client_; }
  jobs::Lease lease(absl::Duration expires_in) const;

  grpc::Status Heartbeat(grpc::ServerContext* context, const v1::HeartbeatRequest* request,
                         v1::HeartbeatResponse* response) override;

  void Cancel() {
    Set([this] { cancel_ = true; });
  }
  void LoseLease() {
    Set([this] { lost_ = true; });
  }
  /// From now on every call hangs until its deadline.
  void FallSilent() {
    Set([this] { silent_ = true; });
  }
  /// Steps in the order in which they came.
  std::vector<int64_t> steps() const;
  int held() const;  ///< heartbeats with a hold so far

 private:
  template <typename Change>
  void Set(Change change) {
    std::lock_guard lock(mutex_);
    change();
    changed_.notify_all();
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool cancel_ = false;
  bool lost_ = false;
  bool silent_ = false;
  bool ending_ = false;
  int held_ = 0;
  std::vector<int64_t> steps_;
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<worker::WorkerClient> client_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_SERVER_WORKER_FAKE_SERVER_H_
