#ifndef POISE_CORE_CORRECTION_TRACKING_TRACKING_EPISODE_H_
#define POISE_CORE_CORRECTION_TRACKING_TRACKING_EPISODE_H_

#include "core/correction/reference_motion.h"
#include "core/correction/tracking/tracking_config.h"
#include "core/physics/world.h"

namespace poise::correction {

/// What is asked of the body for one frame, beside the reference's pose.
struct FrameCommand {
  /// Added to each joint's target, as a rotation vector in the target's axes; at the root a wrench
  /// that the stance legs exert more [N, N m], in world axes.
  physics::Speeds offset = physics::Speeds::Zero();
  double residual_scale = 1;         ///< [0 to 1] on the gains of the PD-residual
  Vec3 outer_force = Vec3::Zero();   ///< [N] on the pelvis, beside the PD-residual; world axes
  Vec3 outer_torque = Vec3::Zero();  ///< [N m]
};

/// What a frame's steps came to, up to a fall.
struct FrameEffort {
  int steps = 0;
  int saturated_joints = 0;  ///< over all steps
};

/// The controller without learning imitates a motion, frame by frame: one World, reused.
/// Threads: one caller at a time.
class TrackingEpisode {
 public:
  /// `world.rate_hz` is rounded so that a frame is a whole number of steps.
  /// Errors: kInvalidArgument CONFIG_VALUE_OUT_OF_RANGE, those of World.
  static StatusOr<TrackingEpisode> Create(physics::HumanoidModelPtr model,
                                          const physics::WorldConfig& world, double frame_rate,
                                          const TrackingConfig& config = {});

  /// Places the body in the reference's pose and velocity of `frame`. `reference` must be of the
  /// same character and frame rate, and outlive the episode.
  void Start(const ReferenceMotion& reference, int frame = 0);

  /// One frame on; past the last one the reference stands still. Goes on after a fall.
  /// Errors: kOutOfRange DIVERGED (a velocity above 100 m/s or rad/s, or no number).
  StatusOr<FrameEffort> Advance(const FrameCommand& command = {});

  int frame() const { return frame_; }
  /// A fall, or the pelvis beyond its limit, since Start.
  bool failed() const { return failed_; }
  /// State, contacts and the effort of the last step.
  const physics::World& world() const { return world_; }
  const physics::HumanoidModel& model() const { return *model_; }
  const TrackingConfig& config() const { return config_; }

 private:
  TrackingEpisode(physics::HumanoidModelPtr model, physics::World world, int steps_per_frame,
                  const TrackingConfig& config);

  void Aim(double time_s, const FrameCommand& command);
  physics::Speeds FeedForward(double time_s, const physics::State& wanted,
                              const physics::Speeds& offset) const;
  void HoldResidual(const physics::State& wanted, const physics::ResidualGains& gains);
  bool Failed(double time_s) const;

  physics::HumanoidModelPtr model_;
  physics::World world_;
  int steps_per_frame_;
  int steps_per_aim_;
  TrackingConfig config_;

  const ReferenceMotion* reference_ = nullptr;
  physics::Drive drive_;
  int frame_ = 0;
  int step_ = 0;  // since Start
  int start_frame_ = 0;
  bool failed_ = false;
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_TRACKING_TRACKING_EPISODE_H_
