#ifndef POISE_CORE_CORRECTION_CORRECTOR_H_
#define POISE_CORE_CORRECTION_CORRECTOR_H_

#include "core/base/run_context.h"
#include "core/correction/correction_config.h"
#include "core/correction/debias/debiaser.h"
#include "core/correction/tracking/iterative_learning.h"
#include "core/correction/tracking/motion_tracker.h"
#include "core/motion/metrics/plausibility.h"

namespace poise::correction {

/// A motion after a simulated body has imitated it.
struct Correction {
  /// What the body did, on the skeleton of the variant, frame by frame; joints that the character
  /// lacks (toes, fingers) keep their rotations. Stands on the floor y = 0.
  motion::Clip clip;
  TrackingScore score;
  std::string effort;                   ///< whose recording this is: instant | fast | full
  std::vector<TrackingScore> rollouts;  ///< of the effort `fast`, in their order; else the score
  bool timed_out = false;               ///< learning met its deadline; this is the best so far
  /// Both by the character's own bodies, against the floor that it stands on.
  motion::Plausibility before, after;
};

/// Makes variants of one clip physically plausible by imitation: reduces them to the character's
/// joints, puts them on the floor, lets the character imitate them (CorrectionConfig::effort says
/// how hard it tries), and measures.
/// The character is that of the source clip: its bone lengths, and its soles where they stand.
/// Threads: Correct may be called from several threads; each call has its own world.
class Corrector {
 public:
  /// With a debiaser, what the body did is debiased before it is measured.
  /// Errors: kFailedPrecondition MISSING_ROLES, UNUSUAL_HIERARCHY; kInvalidArgument
  /// CONFIG_VALUE_OUT_OF_RANGE.
  static StatusOr<Corrector> Create(const motion::Clip& source, const motion::JointRoles& roles,
                                    const CorrectionConfig& config = {},
                                    DebiaserPtr debiaser = nullptr);

  /// `variant` has the source's skeleton. A motion that could not be completed is a result, with
  /// score.completed false; its clip shows the fall.
  /// Errors: kInvalidArgument WRONG_SKELETON; kFailedPrecondition CLIP_TOO_SHORT; kOutOfRange
  /// DIVERGED; kCancelled, kDeadlineExceeded of `context`.
  StatusOr<Correction> Correct(const motion::Clip& variant,
                               const base::RunContext& context = {}) const;

  /// The steps of Correct, for whoever tracks in another way.
  /// The variant as the character is to imitate it. Errors: WRONG_SKELETON, CLIP_TOO_SHORT.
  StatusOr<ReferenceMotion> Reference(const motion::Clip& variant) const;
  /// What the character makes of it, with the config's effort. Errors: as Correct.
  StatusOr<Learned> Imitate(const ReferenceMotion& reference,
                            const base::RunContext& context = {}) const;
  /// Of references at this rate.
  StatusOr<MotionTracker> Tracker(double frame_rate) const;
  /// Correction::before: how plausible it looks by the character's own bodies.
  StatusOr<motion::Plausibility> AssessReference(const ReferenceMotion& reference) const;
  /// What a recording is worth; `reference` is that of `variant`.
  StatusOr<Correction> Assess(const motion::Clip& variant, const ReferenceMotion& reference,
                              const Recording& recording) const;

  const physics::HumanoidModelPtr& shared_model() const { return model_; }
  const physics::HumanoidModel& model() const { return *model_; }
  const CorrectionConfig& config() const { return config_; }

 private:
  Corrector(motion::SkeletonPtr skeleton, motion::JointRoles roles, physics::HumanoidModelPtr model,
            const CorrectionConfig& config, DebiaserPtr debiaser)
      : skeleton_(std::move(skeleton)),
        roles_(std::move(roles)),
        model_(std::move(model)),
        config_(config),
        debiaser_(std::move(debiaser)) {}

  motion::SkeletonPtr skeleton_;
  motion::JointRoles roles_;
  physics::HumanoidModelPtr model_;  // on the reduced skeleton
  CorrectionConfig config_;
  DebiaserPtr debiaser_;  // none: nothing is debiased
};

}  // namespace poise::correction

#endif  // POISE_CORE_CORRECTION_CORRECTOR_H_
