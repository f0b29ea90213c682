#ifndef POISE_CORE_PIPELINE_MAKE_POLICY_LEARNER_H_
#define POISE_CORE_PIPELINE_MAKE_POLICY_LEARNER_H_

#include <memory>

#include "core/correction/policy_learner.h"

namespace poise::pipeline {

/// The learner of effort `full`, a correction::PolicyLearnerFactory. Needs LibTorch: apart from the
/// flows (poise_training). Errors: those of ImitationLearner::Create.
StatusOr<std::unique_ptr<correction::PolicyLearner>> MakePolicyLearner(
    const correction::Corrector& corrector, correction::VariantSource variants,
    const correction::ImitationConfig& config, uint64_t seed);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_MAKE_POLICY_LEARNER_H_
