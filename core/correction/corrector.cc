#include "core/correction/corrector.h"

#include <fmt/format.h>

#include "core/motion/editing/reduce.h"

namespace poise::correction {

StatusOr<Corrector> Corrector::Create(const motion::Clip& source, const motion::JointRoles& roles,
                                      const CorrectionConfig& config) {
  CorrectionConfig checked = config;
  POISE_RETURN_IF_ERROR(base::CheckRanges(checked.Fields()));
  POISE_ASSIGN_OR_RETURN(const motion::Clip reduced,
                         motion::ReduceToRoles(source, roles, motion::ReductionMode::kComposed));
  POISE_ASSIGN_OR_RETURN(const motion::JointRoles reduced_roles,
                         motion::ReducedRoles(*reduced.skeleton()));
  POISE_ASSIGN_OR_RETURN(physics::HumanoidModelPtr model,
                         physics::HumanoidModel::Create(reduced, reduced_roles, config.humanoid));
  return Corrector(source.skeleton(), roles, std::move(model), config);
}

StatusOr<Correction> Corrector::Correct(const motion::Clip& variant,
                                        const base::RunContext& context) const {
  if (!variant.skeleton()->SameAs(*skeleton_)) {
    return base::InvalidArgument(
        "WRONG_SKELETON", "clip",
        fmt::format("clip '{}' has another skeleton than the character's source", variant.name()));
  }
  POISE_ASSIGN_OR_RETURN(const motion::Clip reduced,
                         motion::ReduceToRoles(variant, roles_, motion::ReductionMode::kComposed));
  POISE_ASSIGN_OR_RETURN(const ReferenceMotion reference,
                         ReferenceMotion::Create(reduced, *model_, config_.reference));
  POISE_ASSIGN_OR_RETURN(MotionTracker tracker,
                         MotionTracker::Create(model_, config_.world, reference.frame_rate(),
                                               config_.tracking, config_.reward));
  LearningConfig learning = config_.learning;
  if (config_.effort == "instant") learning.rollouts = 1;
  POISE_ASSIGN_OR_RETURN(Learned learned, LearnIteratively(tracker, reference, learning, context));
  const Recording& recording = learned.best;
  POISE_ASSIGN_OR_RETURN(
      const motion::Plausibility before,
      motion::AssessPlausibility(reference.clip(), model_->shapes(), /*floor_height_m=*/0));
  POISE_ASSIGN_OR_RETURN(
      const motion::Plausibility after,
      motion::AssessPlausibility(recording.clip, model_->shapes(), /*floor_height_m=*/0));
  POISE_ASSIGN_OR_RETURN(motion::Clip clip,
                         motion::ExpandFromRoles(recording.clip, variant, roles_));
  return Correction{.clip = std::move(clip),
                    .score = recording.score,
                    .rollouts = std::move(learned.scores),
                    .timed_out = learned.timed_out,
                    .before = before,
                    .after = after};
}

}  // namespace poise::correction
