#ifndef POISE_CORE_CORRECTION_TRACKING_ITERATIVE_LEARNING_H_
#define POISE_CORE_CORRECTION_TRACKING_ITERATIVE_LEARNING_H_

#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/correction/tracking/motion_tracker.h"

namespace poise::correction {

/// Iterative learning control: the same motion is imitated a few times, and what lagged behind in
/// one rollout is aimed ahead in the next (correction spike, sec. 5). We differ: the residual
/// wrench is learned away, too, by asking the stance legs for it, and its gains are lowered
/// meanwhile. Defaults are the preset `recommended`.
struct LearningConfig {
  int rollouts = 24;         ///< [1 to 1000] the first is the controller without learning
  double joint_gain = 0.05;  ///< [0 to 1] part of a joint's lag that its target is moved by
  double wrench_gain = 0.8;  ///< [0 to 1] part of the residual that the legs are asked for
  double lead_s = 0.05;      ///< [s, 0 to 1] how much earlier a joint's lag is met
  double cutoff_hz = 6;      ///< [Hz, > 0] zero-phase low-pass of what is learned
  /// [0 to 1, > 0] What the PD-residual's gains are multiplied by after a rollout that was
  /// completed (and divided by after another), down to residual_least of the controller's. 1: they
  /// stay.
  double residual_decay = 0.985;
  double residual_least = 0.3;  ///< [0 to 1]
  /// [>= 0] of the mean residual force [body weights] against the normalised reward, where the best
  /// rollout is chosen.
  double force_weight = 1;

  /// `paper`: from the zero policy, which lags more: the spike's 8 rollouts with larger steps.
  /// Errors: kInvalidArgument UNKNOWN_PRESET.
  static StatusOr<LearningConfig> FromPreset(std::string_view preset);

  std::vector<base::Field> Fields();
};

/// What learning came to.
struct Learned {
  /// Completed before not completed, then by normalised reward less the weighted force; none with
  /// less normalised reward than the first, where that was completed.
  Recording best;
  std::vector<TrackingScore> scores;  ///< of all rollouts, in their order
  bool timed_out = false;             ///< the deadline came first; this is the best so far
};

/// Errors: those of MotionTracker::Track of the first rollout; a later one that diverges ends
/// learning, one that meets the deadline of `context` sets timed_out. kCancelled at any time.
/// `steered` says what is asked of the body beside what is learned (a policy's actions); may be
/// empty.
StatusOr<Learned> LearnIteratively(MotionTracker& tracker, const ReferenceMotion& reference,
                                   const LearningConfig& config,
                                   const base::RunContext& context = {},
                                   const Commander& steered = {});

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_TRACKING_ITERATIVE_LEARNING_H_
