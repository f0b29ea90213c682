#include "core/synthesis/ik/propagation.h"

#include <algorithm>
#include <cmath>

namespace poise::synthesis {

Propagation Propagate(int num_frames, double frame_rate, int keyframe, const IkConfig& config) {
  // Frames from the keyframe to where the weight becomes 0, on either side.
  double before = keyframe;
  double after = num_frames - 1 - keyframe;
  if (config.propagation == "window") before = after = config.window_s * frame_rate;

  const int first = std::max(0, static_cast<int>(std::floor(keyframe - before)) + 1);
  const int last = std::min(num_frames - 1, static_cast<int>(std::ceil(keyframe + after)) - 1);
  Propagation propagation{.first = std::min(first, keyframe), .weights = {}};
  for (int frame = propagation.first; frame <= std::max(last, keyframe); ++frame) {
    const double distance = frame <= keyframe ? (keyframe - frame) / std::max(before, 1.0)
                                              : (frame - keyframe) / std::max(after, 1.0);
    const double u = std::clamp(1 - distance, 0.0, 1.0);
    const bool smooth = config.profile == "minimum_jerk";
    propagation.weights.push_back(smooth ? u * u * u * (10 + u * (6 * u - 15)) : u);
  }
  return propagation;
}

}  // namespace poise::synthesis
