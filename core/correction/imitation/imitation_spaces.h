#ifndef POISE_CORE_CORRECTION_IMITATION_IMITATION_SPACES_H_
#define POISE_CORE_CORRECTION_IMITATION_IMITATION_SPACES_H_

#include <span>
#include <vector>

#include "core/correction/imitation/imitation_config.h"
#include "core/correction/tracking/tracking_episode.h"

namespace poise::correction {

/// What a policy sees of an imitation and what its actions mean: the same in training and after it.
/// Vectors are in the frame of the reference's heading, so that a turn of the whole changes
/// nothing.
///
/// Observation, j the joints with a motor: lag of each joint against its reference (rotation vector
/// in the body's axes, 3 j), its speed (3 j) and the reference's (3 j), the reference's turn until
/// look_ahead_s later (3 j); the pelvis' lag in position, rotation and both velocities (12), its
/// velocities (6), the reference's change of both until look_ahead_s later (6), its height and the
/// way up (4); of each foot its place from the pelvis, its lag and whether it touches (2 x 7); the
/// part of the motion that has passed and the first harmonics of it (9).
///
/// Action: turn of each joint's target (3 j); with feed-forward a wrench asked of the stance legs
/// (6); by `residual` the factor on the gains of the PD-residual (pd_scaled: 1) or an outer wrench
/// (rfc, pd_rfc: 6). All zero is the controller without learning (with rfc and none, without its
/// residual).
/// Source: correction spike, sec. 5; MotionAug sec. 4.7, 4.8. We differ: rotation vectors instead
/// of angle and axis, errors instead of two poses.
class ImitationSpaces {
 public:
  ImitationSpaces(physics::HumanoidModelPtr model, const TrackingConfig& tracking,
                  const ImitationConfig& config);

  int observation_size() const { return observation_size_; }
  int action_size() const { return action_size_; }

  /// observation: (observation_size)
  void Observe(const TrackingEpisode& episode, const ReferenceMotion& reference,
               std::span<float> observation) const;
  /// action: (action_size); `wanted` is the reference where it is taken.
  FrameCommand Command(std::span<const float> action, const physics::State& wanted) const;

 private:
  physics::HumanoidModelPtr model_;
  ImitationConfig config_;
  std::vector<int> motors_;  // bodies whose joint has one
  bool asks_legs_;           // actions hold a wrench for the stance legs
  int observation_size_ = 0;
  int action_size_ = 0;
};

/// How many frames an action is held: at least 1.
int FramesPerAction(const ImitationConfig& config, double frame_rate);

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_IMITATION_IMITATION_SPACES_H_
