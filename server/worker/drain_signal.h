#ifndef POISE_SERVER_WORKER_DRAIN_SIGNAL_H_
#define POISE_SERVER_WORKER_DRAIN_SIGNAL_H_

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>

#include "absl/time/time.h"

namespace poise::worker {

/// How a worker goes away.
enum class DrainStage {
  kWork,
  kDrain,  ///< no new jobs; those that run save a checkpoint and are given back
  kHurry,  ///< now: what runs is killed, each call is tried once
};

/// Tells all who work for this worker that it goes away.
/// Threads: all members may be called from any thread.
class DrainSignal {
 public:
  DrainStage stage() const;
  /// Stages only go forward.
  void Advance(DrainStage stage);
  /// Waits for a stage after kWork, `limit` at most; true when it came.
  bool WaitFor(absl::Duration limit);

  /// Calls `on_drain` once, when the first stage after kWork comes (now, if it has come), unless it
  /// goes away before. `on_drain` must be quick.
  class Listener {
   public:
    Listener(DrainSignal& signal, std::function<void()> on_drain);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

   private:
    DrainSignal& signal_;
  };

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  DrainStage stage_ = DrainStage::kWork;
  std::map<const Listener*, std::function<void()>> listeners_;
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_DRAIN_SIGNAL_H_
