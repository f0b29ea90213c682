#include "core/pipeline/correct_settings.h"

#include <string>
#include <utility>

#include "core/synthesis/synthesizer_registry.h"

namespace poise::pipeline {
namespace {

using correction::CorrectionConfig;
using correction::ImitationConfig;

/// Of a limited time, the part in which a policy is learned; the variants have the rest.
constexpr double kTrainingShare = 0.75;
constexpr char kLearner[] = "imitation";

/// Overrides by whom they are for.
struct SortedOverrides {
  base::Overrides method, learner, correction;
};

SortedOverrides Sort(const api::CorrectSpec& spec) {
  SortedOverrides sorted;
  for (const auto& [key, value] : spec.overrides) {
    const std::string owner = key.substr(0, key.find('.'));
    const bool is_step = ("+" + spec.method + "+").find("+" + owner + "+") != std::string::npos;
    base::Overrides& overrides = is_step             ? sorted.method
                                 : owner == kLearner ? sorted.learner
                                                     : sorted.correction;
    overrides[key] = value;
  }
  return sorted;
}

StatusOr<ImitationConfig> Imitation(const api::CorrectSpec& spec,
                                    const base::Overrides& overrides) {
  POISE_ASSIGN_OR_RETURN(ImitationConfig config, ImitationConfig::FromPreset(spec.preset));
  // The preset's own wrench is one by the pelvis' error.
  if (spec.residual != "pd") config.residual = spec.residual;
  if (spec.max_seconds > 0) {
    config.max_seconds =
        kTrainingShare * spec.max_seconds / static_cast<double>(spec.sources.size());
  }
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, base::Nested(kLearner, config.Fields())));
  if (const Status status = config.Validate(); !status.ok()) {
    return base::Annotate(status, kLearner, kLearner);
  }
  return config;
}

}  // namespace

StatusOr<CorrectSettings> CorrectSettings::From(const api::CorrectSpec& spec) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  const SortedOverrides overrides = Sort(spec);
  CorrectSettings settings;
  CorrectionConfig& config = settings.correction;
  POISE_ASSIGN_OR_RETURN(config, CorrectionConfig::FromPreset(spec.preset));
  settings.learns = spec.effort == "full";
  config.effort = settings.learns ? "fast" : spec.effort;
  if (spec.body_mass_kg > 0) config.humanoid.body_mass_kg = spec.body_mass_kg;
  const bool pelvis_is_held = spec.residual == "pd" || spec.residual == "pd_rfc";
  if (!pelvis_is_held) config.tracking.residual_factor = 0;
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides.correction, config.Fields()));
  POISE_RETURN_IF_ERROR(base::CheckRanges(config.Fields()));
  POISE_ASSIGN_OR_RETURN(settings.imitation, Imitation(spec, overrides.learner));
  return settings;
}

api::AugmentSpec AugmentSpecOf(const api::CorrectSpec& spec, uint64_t seed) {
  api::AugmentSpec augment;
  augment.sources = spec.sources;
  augment.method = spec.method;
  augment.action_class = spec.action_class;
  augment.preset = spec.preset;
  augment.variants_per_source = spec.Variants();
  augment.seed = seed;
  augment.overrides = Sort(spec).method;
  augment.with_plausibility = false;  // the corrector measures, by the character's own bodies
  return augment;
}

Status CheckCorrect(const api::CorrectSpec& spec) {
  POISE_RETURN_IF_ERROR(CorrectSettings::From(spec).status());
  if (spec.method == kNoMethod) return absl::OkStatus();
  const api::AugmentSpec augment = AugmentSpecOf(spec, /*seed=*/0);
  return synthesis::CreateMethod(augment.method, {.action_class = augment.action_class,
                                                  .preset = augment.preset,
                                                  .overrides = augment.overrides,
                                                  .check_only = !spec.model_artifact.empty()})
      .status();
}

CorrectionConfig ZeroPolicyConfig(const CorrectionConfig& config) {
  CorrectionConfig zero = *CorrectionConfig::FromPreset("paper");
  zero.effort = "instant";
  zero.humanoid.body_mass_kg = config.humanoid.body_mass_kg;
  return zero;
}

}  // namespace poise::pipeline
