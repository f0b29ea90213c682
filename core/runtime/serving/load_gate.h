#ifndef POISE_CORE_RUNTIME_SERVING_LOAD_GATE_H_
#define POISE_CORE_RUNTIME_SERVING_LOAD_GATE_H_

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "core/runtime/serving/serving_config.h"

namespace poise::serving {

/// Lets as many requests in as may be at work or waiting, and tells the others when to come again:
/// after the time in which those inside, and all who were sent away lately, would have been served.
/// So the more are sent away, the rarer each of them asks. Times are spread by half, so that those
/// who were refused together do not come back together.
/// Threads: all members may be called from any thread.
class LoadGate : public std::enable_shared_from_this<LoadGate> {
 public:
  /// A request inside; leaves with its destruction.
  class Place {
   public:
    explicit Place(std::shared_ptr<LoadGate> gate) : gate_(std::move(gate)) {}
    ~Place() {
      if (gate_) gate_->Leave();
    }
    Place(Place&&) = default;
    Place& operator=(Place&&) = delete;

   private:
    std::shared_ptr<LoadGate> gate_;
  };

  /// `telemetry` outlives the gate.
  LoadGate(const ServingConfig& config, base::Telemetry& telemetry, const base::Labels& labels);

  /// Errors: kResourceExhausted MODEL_BUSY with a retry time.
  StatusOr<Place> Enter();

 private:
  // What happened in a stretch of time.
  struct Tally {
    int64_t served = 0;
    int64_t refused = 0;
  };

  void Leave();
  // With mutex_ held.
  void Turn(absl::Time now);
  absl::Duration RetryDelay();

  const ServingConfig config_;
  base::Gauge& inside_gauge_;
  base::Counter& refused_;
  std::mutex mutex_;
  int inside_ = 0;
  absl::Time begin_;  // of the current stretch
  Tally current_, last_;
  uint32_t spread_ = 0;
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_LOAD_GATE_H_
