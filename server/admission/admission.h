#ifndef POISE_SERVER_ADMISSION_ADMISSION_H_
#define POISE_SERVER_ADMISSION_ADMISSION_H_

#include <grpcpp/server_context.h>

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "server/admission/method_policy.h"

namespace poise::server {

struct AdmissionConfig {
  int max_calls = 512;           ///< [> 0] calls at work at the same time
  int max_calls_per_peer = 160;  ///< [> 0] of them from one client address
  std::string token;  ///< when not empty, calls must carry it ("authorization: Bearer ...")
};

class Admission;

/// One admitted call: its place among the calls at work, given back by the destructor.
class Call {
 public:
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  const base::RunContext& run() const { return run_; }
  const std::string& request_id() const { return request_id_; }
  /// Makes the work of this call stop.
  void Cancel() { run_.cancellation.Cancel(); }

 private:
  friend class Admission;
  Call(Admission& admission, std::string peer, std::string request_id, absl::Time deadline);

  Admission& admission_;
  std::string peer_;
  std::string request_id_;
  base::RunContext run_;
};

/// What every method passes before it does anything: request id, identity, limits, deadline. (An
/// interceptor of gRPC 1.51 cannot refuse a call.)
/// Threads: all members may be called from any thread.
class Admission {
 public:
  Admission(AdmissionConfig config, base::Telemetry& telemetry);

  /// Sends the request id back in the initial metadata ("x-request-id": the caller's, or a new
  /// one). Errors: kUnauthenticated MISSING_TOKEN, WRONG_TOKEN; kResourceExhausted TOO_MANY_CALLS,
  /// TOO_MANY_CALLS_OF_PEER, with a retry time; kUnavailable SHUTTING_DOWN.
  StatusOr<std::unique_ptr<Call>> Admit(grpc::CallbackServerContext& context,
                                        const MethodPolicy& policy);

  /// From now on every call is refused with SHUTTING_DOWN.
  void Close();

  int calls() const;
  /// Returns when no call is at work. (The last task of a call may run on a little after gRPC is
  /// done with it.)
  void WaitUntilIdle();

 private:
  friend class Call;
  Status CheckToken(const grpc::CallbackServerContext& context) const;
  Status TakePlace(const std::string& peer);
  void GivePlace(const std::string& peer);

  const AdmissionConfig config_;
  base::Gauge& calls_gauge_;
  base::Counter& refused_;
  mutable std::mutex mutex_;
  std::condition_variable idle_;
  bool closed_ = false;
  int calls_ = 0;
  std::map<std::string, int> calls_of_peer_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_ADMISSION_ADMISSION_H_
