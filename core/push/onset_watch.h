#ifndef POISE_CORE_PUSH_ONSET_WATCH_H_
#define POISE_CORE_PUSH_ONSET_WATCH_H_

#include <Eigen/Core>
#include <vector>

namespace poise::push {

/// Notes when each person begins to move: the frame from which the hip goes at 0.1 m/s or more for
/// two frames. The speed is that of the data set's rule for its recordings, in any direction.
class OnsetWatch {
 public:
  explicit OnsetWatch(int people) : onsets_(people, -1), moving_(people, false) {}

  /// `velocities` (people, 3) [m/s] of the hips in this frame; frames come in order.
  void Observe(int frame, const Eigen::ArrayX3d& velocities);

  /// -1: has not moved yet.
  const std::vector<int>& onset_frames() const { return onsets_; }

 private:
  std::vector<int> onsets_;
  std::vector<bool> moving_;  // in the frame before
};

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_ONSET_WATCH_H_
