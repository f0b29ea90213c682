#include "core/correction/debias/debias_pairs.h"

#include <fmt/format.h>

#include <utility>

#include "core/correction/corrector.h"
#include "core/math/rotation.h"

namespace poise::correction {
namespace {

StatusOr<std::vector<DebiasPair>> Imitate(const DebiasClip& labelled,
                                          const CorrectionConfig& correction,
                                          const base::RunContext& context) {
  const motion::Clip& clip = labelled.clip;
  POISE_ASSIGN_OR_RETURN(const motion::JointRoles roles,
                         motion::JointRoles::Detect(*clip.skeleton()));
  POISE_ASSIGN_OR_RETURN(const Corrector corrector, Corrector::Create(clip, roles, correction));
  POISE_ASSIGN_OR_RETURN(const ReferenceMotion reference, corrector.Reference(clip));
  StatusOr<Learned> learned = corrector.Imitate(reference, context);
  std::vector<DebiasPair> pairs;
  if (!learned.ok() && base::ErrorReason(learned.status()) == "DIVERGED") return pairs;
  POISE_RETURN_IF_ERROR(learned.status());
  if (learned->best.score.completed) {
    pairs.push_back({std::move(learned->best.clip), reference.source_clip(),
                     corrector.shared_model(), labelled.actor});
  }
  return pairs;
}

}  // namespace

StatusOr<CorrectionConfig> CorrectionOf(const DebiasConfig& config) {
  POISE_ASSIGN_OR_RETURN(CorrectionConfig correction,
                         CorrectionConfig::FromPreset(config.correction));
  correction.effort = config.effort;
  return correction;
}

StatusOr<std::vector<DebiasPair>> MakeDebiasPairs(const std::vector<DebiasClip>& clips,
                                                  const CorrectionConfig& correction,
                                                  const base::RunContext& context) {
  std::vector<DebiasPair> pairs;
  for (size_t i = 0; i < clips.size(); ++i) {
    StatusOr<std::vector<DebiasPair>> one = Imitate(clips[i], correction, context);
    if (!one.ok()) {
      return base::Annotate(one.status(), fmt::format("clip '{}'", clips[i].clip.name()));
    }
    for (DebiasPair& pair : *one) pairs.push_back(std::move(pair));
    context.Report({.step = static_cast<int64_t>(i + 1),
                    .total = static_cast<int64_t>(clips.size()),
                    .message = "imitating"});
  }
  return pairs;
}

PairError ErrorBetween(const motion::Clip& motion, const motion::Clip& original) {
  PairError error;
  for (int f = 0; f < motion.num_frames(); ++f) {
    error.root_m += (motion.root_position(f) - original.root_position(f)).norm();
    for (int j = 0; j < motion.num_joints(); ++j) {
      error.joint_rad += math::GeodesicDistance(motion.rotation(f, j), original.rotation(f, j)) /
                         motion.num_joints();
    }
  }
  error.root_m /= motion.num_frames();
  error.joint_rad /= motion.num_frames();
  return error;
}

}  // namespace poise::correction
