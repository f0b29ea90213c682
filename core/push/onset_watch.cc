#include "core/push/onset_watch.h"

namespace poise::push {

void OnsetWatch::Observe(int frame, const Eigen::ArrayX3d& velocities) {
  constexpr double kMovingSpeed = 0.1;  // [m/s]
  for (size_t i = 0; i < onsets_.size(); ++i) {
    const bool moving = velocities.row(i).leftCols<2>().matrix().norm() >= kMovingSpeed;
    if (moving && moving_[i] && onsets_[i] < 0) onsets_[i] = frame - 1;
    moving_[i] = moving;
  }
}

}  // namespace poise::push
