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
};

}  // namespace poise::learning

#endif  // POISE_CORE_LEARNING_NN_CHECKPOINT_SINK_H_
