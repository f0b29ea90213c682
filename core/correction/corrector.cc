#include "core/correction/corrector.h"

#include <fmt/format.h>

#include "core/motion/editing/reduce.h"

namespace poise::correction {

StatusOr<Corrector> Corrector::Create(const motion::Clip& source, const motion::JointRoles& roles,
                                      const CorrectionConfig& config, DebiaserPtr debiaser) {
  CorrectionConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_ASSIGN_OR_RETURN(const motion::Clip reduced,
                         motion::ReduceToRoles(source, roles, motion::ReductionMode::kComposed));
  POISE_ASSIGN_OR_RETURN(const motion::JointRoles reduced_roles,
                         motion::ReducedRoles(*reduced.skeleton()));
  POISE_ASSIGN_OR_RETURN(physics::HumanoidModelPtr model,
                         physics::HumanoidModel::Create(reduced, reduced_roles, config.humanoid));
  return Corrector(source.skeleton(), roles, std::move(model), config, std::move(debiaser));
}

StatusOr<ReferenceMotion> Corrector::Reference(const motion::Clip& variant) const {
  if (!variant.skeleton()->SameAs(*skeleton_)) {
    return base::InvalidArgument(
        "WRONG_SKELETON", "clip",
        fmt::format("clip '{}' has another skeleton than the character's source", variant.name()));
  }
  POISE_ASSIGN_OR_RETURN(const motion::Clip reduced,
                         motion::ReduceToRoles(variant, roles_, motion::ReductionMode::kComposed));
  return ReferenceMotion::Create(reduced, *model_, config_.reference);
}

StatusOr<MotionTracker> Corrector::Tracker(double frame_rate) const {
  return MotionTracker::Create(model_, config_.world, frame_rate, config_.tracking, config_.reward);
}

StatusOr<motion::Plausibility> Corrector::AssessReference(const ReferenceMotion& reference) const {
  return motion::AssessPlausibility(reference.source_clip(), model_->shapes(),
                                    /*floor_height_m=*/0);
}

StatusOr<Correction> Corrector::Assess(const motion::Clip& variant,
                                       const ReferenceMotion& reference,
                                       const Recording& recording) const {
  POISE_ASSIGN_OR_RETURN(const motion::Plausibility before, AssessReference(reference));
  motion::Clip done = recording.clip;
  if (debiaser_ != nullptr) {
    POISE_ASSIGN_OR_RETURN(done, debiaser_->Apply(recording.clip, *model_));
  }
  POISE_ASSIGN_OR_RETURN(const motion::Plausibility after,
                         motion::AssessPlausibility(done, model_->shapes(), /*floor_height_m=*/0));
  POISE_ASSIGN_OR_RETURN(motion::Clip clip, motion::ExpandFromRoles(done, variant, roles_));
  return Correction{.clip = std::move(clip),
                    .score = recording.score,
                    .effort = config_.effort,
                    .rollouts = {recording.score},
                    .timed_out = false,
                    .before = before,
                    .after = after};
}

StatusOr<Learned> Corrector::Imitate(const ReferenceMotion& reference,
                                     const base::RunContext& context) const {
  POISE_ASSIGN_OR_RETURN(MotionTracker tracker, Tracker(reference.frame_rate()));
  LearningConfig learning = config_.learning;
  if (config_.effort == "instant") learning.rollouts = 1;
  return LearnIteratively(tracker, reference, learning, context);
}

StatusOr<Correction> Corrector::Correct(const motion::Clip& variant,
                                        const base::RunContext& context) const {
  POISE_ASSIGN_OR_RETURN(const ReferenceMotion reference, Reference(variant));
  POISE_ASSIGN_OR_RETURN(Learned learned, Imitate(reference, context));
  POISE_ASSIGN_OR_RETURN(Correction correction, Assess(variant, reference, learned.best));
  correction.rollouts = std::move(learned.scores);
  correction.timed_out = learned.timed_out;
  return correction;
}

}  // namespace poise::correction
