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
  /// [> 0] Watches, long polls and heartbeats on hold; they take no thread and no other place.
  int max_waiting_calls = 10'000;
  double worker_share = 0.1;  ///< [0 .. 1] of the waiting calls that watches leave free
  std::string token;          ///< when not empty, calls must carry it ("authorization: Bearer ...")
};

class Admission;

/// Who calls, as far as it is known.
struct CallOrigin {
  std::string peer;        ///< "ipv4:10.0.0.1", without the port
  std::string request_id;  ///< the caller's, or a new one
  std::string tenant;      ///< of the metadata "x-poise-tenant", or "default"
  std::string trace_id;    ///< of the W3C "traceparent", or a new one
};

/// One admitted call: its place among the calls at work, given back by the destructor.
class Call {
 public:
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  const base::RunContext& run() const { return run_; }
  const CallOrigin& origin() const { return origin_; }
  const std::string& request_id() const { return origin_.request_id; }
  const std::string& tenant() const { return origin_.tenant; }
  /// Makes the work of this call stop.
  void Cancel() { run_.cancellation.Cancel(); }

 private:
  friend class Admission;
  Call(Admission& admission, CallOrigin origin, Place place, absl::Time deadline);

  Admission& admission_;
  const CallOrigin origin_;
  const Place place_;
  base::RunContext run_;
};

/// What every method passes before it does anything: request id, identity, limits, deadline. (An
/// interceptor of gRPC 1.51 cannot refuse a call.)
/// Threads: all members may be called from any thread.
class Admission {
 public:
  Admission(AdmissionConfig config, base::Telemetry& telemetry);

  /// Sends the request id back in the initial metadata ("x-request-id"), of a refused call in the
  /// trailing one. Errors: kUnauthenticated MISSING_TOKEN, WRONG_TOKEN; kInvalidArgument
  /// BAD_TENANT; kResourceExhausted TOO_MANY_CALLS, TOO_MANY_CALLS_OF_PEER, TOO_MANY_WAITING_CALLS,
  /// with a retry time; kUnavailable SHUTTING_DOWN.
  StatusOr<std::unique_ptr<Call>> Admit(grpc::CallbackServerContext& context,
                                        const MethodPolicy& policy);

  /// From now on every call is refused with SHUTTING_DOWN.
  void Close();

  /// At work and waiting.
  int calls() const;
  /// Returns when no call is at work. (The last task of a call may run on a little after gRPC is
  /// done with it.)
  void WaitUntilIdle();

 private:
  friend class Call;
  Status CheckToken(const grpc::CallbackServerContext& context) const;
  Status TakePlace(const std::string& peer, Place place);
  // With mutex_ held.
  Status TakeWork(const std::string& peer);
  Status TakeWaiting(Place place);
  void GivePlace(const std::string& peer, Place place);

  const AdmissionConfig config_;
  base::Gauge& calls_gauge_;
  base::Gauge& waiting_gauge_;
  base::Counter& refused_;
  mutable std::mutex mutex_;
  std::condition_variable idle_;
  bool closed_ = false;
  int calls_ = 0;    // at work
  int waiting_ = 0;  // and besides
  std::map<std::string, int> calls_of_peer_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_ADMISSION_ADMISSION_H_
