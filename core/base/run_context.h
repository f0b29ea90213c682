#ifndef POISE_CORE_BASE_RUN_CONTEXT_H_
#define POISE_CORE_BASE_RUN_CONTEXT_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "absl/time/time.h"
#include "core/base/status.h"

namespace poise::base {

/// A wish to stop, shared by the one who may wish it (a client, a signal) and the work that obeys.
/// Threads: all members may be called from any thread.
class CancellationToken {
 public:
  CancellationToken() : requested_(std::make_shared<std::atomic<bool>>(false)) {}

  void Cancel() { requested_->store(true, std::memory_order_relaxed); }
  bool cancelled() const { return requested_->load(std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> requested_;
};

/// How far a long task is. `total` is 0 when it is not known.
struct Progress {
  int64_t step = 0;
  int64_t total = 0;
  std::string message;
  std::map<std::string, double> metrics = {};  ///< "reward", "samples", "eta_s", ...
};

/// What goes down with every piece of work: seed, cancellation, deadline, progress. Work of more
/// than about a millisecond asks `Check()` between its steps.
struct RunContext {
  uint64_t seed = 0;
  CancellationToken cancellation;
  absl::Time deadline = absl::InfiniteFuture();
  std::function<void(const Progress&)> progress;  ///< may be empty

  /// Errors: kCancelled (CANCELLED) after Cancel(); kDeadlineExceeded (DEADLINE_EXCEEDED) later
  /// than the deadline.
  Status Check() const;

  void Report(const Progress& value) const {
    if (progress) progress(value);
  }
};

}  // namespace poise::base

#endif  // POISE_CORE_BASE_RUN_CONTEXT_H_
