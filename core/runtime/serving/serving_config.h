#ifndef POISE_CORE_RUNTIME_SERVING_SERVING_CONFIG_H_
#define POISE_CORE_RUNTIME_SERVING_SERVING_CONFIG_H_

#include "absl/time/time.h"

namespace poise::serving {

/// How requests to one trained model share its forward passes, and how many there may be.
struct ServingConfig {
  int max_batch = 16;  ///< [> 0] motions in one forward pass; 1: no batching
  int executors = 0;   ///< [>= 0] forward passes at a time while nobody waits long; 0: one a CPU
  /// [>= 0] A request waits at most so long for others to end or to join it, then it is run
  /// whatever else runs. While an executor is free nobody waits.
  absl::Duration max_added_delay = absl::Milliseconds(10);
  int max_requests = 64;  ///< [> 0] at work or waiting; more are refused with a retry time
  absl::Duration least_retry = absl::Milliseconds(100);  ///< [> 0] bounds of that time
  absl::Duration most_retry = absl::Seconds(5);
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_SERVING_CONFIG_H_
