#ifndef POISE_SERVER_WORKER_SUPERVISOR_H_
#define POISE_SERVER_WORKER_SUPERVISOR_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "core/base/telemetry.h"
#include "server/worker/drain_signal.h"
#include "server/worker/worker_client.h"
#include "server/worker/worker_config.h"

namespace poise::worker {

/// A worker: registers, then on each of its slots leases one job after the other and runs it, until
/// it is told to go away, has nothing to do for too long, or its time is over. A server that does
/// not answer is waited for.
class Supervisor {
 public:
  /// `telemetry` outlives it. `on_registered` is called once.
  Supervisor(WorkerConfig config, base::Telemetry& telemetry, std::function<void()> on_registered);

  /// Returns when all slots have ended. Errors: those of WorkFolder::Create; what the server
  /// answered to the registration, unless that may pass.
  Status Run();

  /// First time: finish or give back what runs, then end. Again: at once.
  /// Threads: any.
  void Stop();

 private:
  using Clock = std::chrono::steady_clock;

  // Returns the server's heartbeat interval; with a drain before the first answer, an error.
  StatusOr<absl::Duration> Register();
  void RunSlot(const std::filesystem::path& folder, absl::Duration heartbeat_interval);
  StatusOr<LeaseAnswer> LeaseJob(const jobs::ClaimQuery& query);
  // A lease that came while the worker was told to go away.
  void GiveBack(const jobs::ClaimQuery& query);
  void NoteServer(const Status& status);
  // Until all slots have ended: looks at the clock.
  void Watch();
  absl::Duration IdleTime() const;
  void Drain(const char* why);

  const WorkerConfig config_;
  base::Telemetry& telemetry_;
  const std::function<void()> on_registered_;
  WorkerClient client_;
  DrainSignal drain_;
  const Clock::time_point start_ = Clock::now();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int slots_ = 0;  ///< that have not ended
  int busy_ = 0;
  Clock::time_point idle_since_ = start_;
  std::optional<Clock::time_point> drain_begin_;
  std::atomic<bool> server_lost_ = false;
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_SUPERVISOR_H_
