#ifndef POISE_CORE_LEARNING_NN_CHECKPOINT_SINK_H_
#define POISE_CORE_LEARNING_NN_CHECKPOINT_SINK_H_

#include <cstdint>
#include <functional>
#include <string_view>

#include "absl/time/time.h"
#include "core/base/status.h"

namespace poise::learning {

/// Where checkpoints go. `save` must keep the bytes or copy them; empty: nowhere.
struct CheckpointSink {
  absl::Duration interval = absl::InfiniteDuration();
  std::function<Status(std::string_view bytes, int64_t step)> save = {};
  /// [0 to 1) Of the time, what checkpoints may take: while they take less, there is one also
  /// before the interval is over, but not before `least_interval` is: to store them takes others'
  /// time, too.
  double share = 0;
  absl::Duration least_interval = absl::Seconds(1);
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_CHECKPOINT_SINK_H_
