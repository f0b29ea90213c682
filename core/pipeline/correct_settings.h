#ifndef POISE_CORE_PIPELINE_CORRECT_SETTINGS_H_
#define POISE_CORE_PIPELINE_CORRECT_SETTINGS_H_

#include <cstdint>

#include "core/api/augment_spec.h"
#include "core/api/correct_spec.h"
#include "core/correction/correction_config.h"
#include "core/correction/imitation/imitation_config.h"

namespace poise::pipeline {

/// A CorrectSpec in the terms of those who do the work.
struct CorrectSettings {
  correction::CorrectionConfig correction;  ///< effort instant or fast, on which full builds
  correction::ImitationConfig imitation;    ///< of effort full
  bool learns = false;                      ///< effort full

  /// Values that are written by hand go before presets and flags: "imitation.ppo.epochs" to the
  /// learner, "ik.radius_low" to a step of the method of that name, others to the correction.
  /// Errors: those of CheckCorrect.
  static StatusOr<CorrectSettings> From(const api::CorrectSpec& spec);
};

/// Corrects clips as they are.
inline constexpr char kNoMethod[] = "none";

/// The request for the variants that are to be corrected; not for the method none.
api::AugmentSpec AugmentSpecOf(const api::CorrectSpec& spec, uint64_t seed);

/// Everything of a CorrectSpec that can be checked without its clips.
/// Errors: those of CorrectSpec::Validate; kInvalidArgument UNKNOWN_METHOD, MISSING_MODEL,
/// UNKNOWN_ACTION_CLASS, UNKNOWN_CONFIG_KEY and the other config errors.
Status CheckCorrect(const api::CorrectSpec& spec);

/// The authors' controller without learning, for the same body mass.
correction::CorrectionConfig ZeroPolicyConfig(const correction::CorrectionConfig& config);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_CORRECT_SETTINGS_H_
