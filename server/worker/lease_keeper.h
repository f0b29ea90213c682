#ifndef POISE_SERVER_WORKER_LEASE_KEEPER_H_
#define POISE_SERVER_WORKER_LEASE_KEEPER_H_

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "core/base/run_context.h"
#include "core/runtime/jobs/job_store.h"
#include "server/worker/worker_client.h"

namespace poise::worker {

/// What the server said about an attempt, or its silence.
enum class Verdict {
  kKeep,    ///< go on
  kCancel,  ///< somebody wishes it to end
  kLost,    ///< it is not ours any more: nothing of it may be handed in
};

struct LeaseKeeperConfig {
  absl::Duration heartbeat_interval = absl::Seconds(10);  ///< how long the server holds an answer
  absl::Duration progress_interval = absl::Seconds(1);    ///< at most one message per this
  /// After an answer that came at once: before the next call.
  absl::Duration shortest_interval = absl::Seconds(1);
  absl::Duration answer_limit = absl::Seconds(10);  ///< for an answer, beyond the time it is held
};

/// Keeps a lease while its attempt runs. One heartbeat is always with the server, which answers it
/// when there is something to tell; progress goes out on others of its own. The lease's end is
/// counted here, on the monotonic clock: when it must have ended and no server has answered, the
/// lease is lost. With the first verdict other than kKeep `stop` is cancelled.
/// Threads: all members may be called from any thread.
class LeaseKeeper {
 public:
  LeaseKeeper(LeaseKeeperConfig config, WorkerClient& client, const jobs::Lease& lease,
              base::CancellationToken stop);
  ~LeaseKeeper();
  LeaseKeeper(const LeaseKeeper&) = delete;
  LeaseKeeper& operator=(const LeaseKeeper&) = delete;

  void Report(const base::Progress& progress);
  /// Sends what Report was last told, if the server does not know it yet, without delay; waits for
  /// that until `limit` is over.
  void FlushProgress(absl::Duration limit);

  Verdict verdict() const;
  bool lost() const { return verdict() == Verdict::kLost; }
  /// Another call of this attempt ended with `status`: LEASE_LOST and JOB_NOT_FOUND lose the lease.
  void Learn(const Status& status);

 private:
  using Clock = std::chrono::steady_clock;

  void HoldHeartbeats();
  void SendProgress();
  // One call, without the lock; true when the server took the lease further.
  bool Beat(const std::optional<base::Progress>& progress, absl::Duration hold,
            CallBreaker& breaker, std::unique_lock<std::mutex>& lock);
  void Decide(Verdict verdict);  // with the lock held
  absl::Duration Left() const;   // with the lock held

  const LeaseKeeperConfig config_;
  WorkerClient& client_;
  const jobs::Fence fence_;
  base::CancellationToken stop_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Verdict verdict_ = Verdict::kKeep;
  Clock::time_point lease_end_;
  std::optional<base::Progress> pending_;
  Clock::time_point next_progress_{};
  bool sending_ = false;
  bool flushing_ = false;
  bool done_ = false;

  CallBreaker hold_breaker_;
  CallBreaker progress_breaker_;
  std::thread holder_;
  std::thread sender_;
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_LEASE_KEEPER_H_
