#include "core/pipeline/make_policy_learner.h"

#include <utility>

#include "core/correction/imitation/imitation_learner.h"

namespace poise::pipeline {

StatusOr<std::unique_ptr<correction::PolicyLearner>> MakePolicyLearner(
    const correction::Corrector& corrector, correction::VariantSource variants,
    const correction::ImitationConfig& config, uint64_t seed) {
  POISE_ASSIGN_OR_RETURN(
      correction::ImitationLearner learner,
      correction::ImitationLearner::Create(corrector, std::move(variants), config, seed));
  return std::make_unique<correction::ImitationLearner>(std::move(learner));
}

}  // namespace poise::pipeline
