#ifndef POISE_CORE_CORRECTION_TRACKING_MOTION_TRACKER_H_
#define POISE_CORE_CORRECTION_TRACKING_MOTION_TRACKER_H_

#include <functional>
#include <vector>

#include "core/base/run_context.h"
#include "core/correction/reference_motion.h"
#include "core/correction/reward.h"
#include "core/correction/tracking/tracking_episode.h"

namespace poise::correction {

/// How well a simulated body imitated one motion. Sums over frames; "until the fall" where the
/// motion was not completed.
struct TrackingScore {
  bool completed = false;             ///< no fall, and the pelvis within its limit all the time
  double completion = 0;              ///< part of the motion until it failed
  double reward_imitation = 0;        ///< mean until the fall
  double reward_normalised = 0;       ///< the same sum over the whole motion: 0 after a fall
  double reward_total = 0;            ///< mean of the total reward, 0 after a fall
  double residual_force_mean_bw = 0;  ///< [body weights] until the fall
  double residual_force_peak_bw = 0;
  double residual_torque_mean_nm = 0;  ///< [N m]
  double residual_torque_peak_nm = 0;
  double torque_saturation = 0;  ///< part of all joints and steps at their limit
  double pose_error_rad = 0;     ///< mean angle over joints
  double pose_error_m = 0;       ///< mean distance over joints
  double pelvis_error_mean_m = 0;
  double pelvis_error_max_m = 0;
};

/// What the body really did, frame by frame beside its reference, from the first to the last frame
/// even after a fall.
struct Recording {
  motion::Clip clip;
  TrackingScore score;
  /// (frames) What was missing: of each joint the rotation vector from its pose to the reference's,
  /// in the body's axes; at the root the residual wrench. 0 after a fall.
  std::vector<physics::Speeds> lags;
};

/// (frames) What is learned of a motion: added to each joint's target, as a rotation vector in the
/// target's axes; at the root a wrench that the stance legs exert more.
using TrackingOffsets = std::vector<physics::Speeds>;

/// Says at the start of each frame what is asked for it; the episode shows where the body is.
using Commander = std::function<FrameCommand(const TrackingEpisode& episode)>;

/// Imitates a motion with the controller without learning, and what is asked of it beside, and
/// scores what the body did. One World, reused.
/// Threads: one caller at a time.
class MotionTracker {
 public:
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE, those of TrackingEpisode.
  static StatusOr<MotionTracker> Create(physics::HumanoidModelPtr model,
                                        const physics::WorldConfig& world, double frame_rate,
                                        const TrackingConfig& config = {},
                                        const RewardConfig& reward = {});

  /// From t = 0. `reference` must be of the same character and frame rate; `offsets` has its
  /// frames. Errors: kCancelled, kDeadlineExceeded of `context`; kOutOfRange DIVERGED.
  StatusOr<Recording> Track(const ReferenceMotion& reference, const base::RunContext& context = {},
                            const TrackingOffsets* offsets = nullptr);
  StatusOr<Recording> Track(const ReferenceMotion& reference, const base::RunContext& context,
                            const Commander& commander);

 private:
  MotionTracker(TrackingEpisode episode, const RewardConfig& reward)
      : episode_(std::move(episode)), reward_(reward) {}

  TrackingEpisode episode_;
  RewardConfig reward_;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_TRACKING_MOTION_TRACKER_H_
