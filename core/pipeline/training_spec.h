#ifndef POISE_CORE_PIPELINE_TRAINING_SPEC_H_
#define POISE_CORE_PIPELINE_TRAINING_SPEC_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/base/status.h"

namespace poise::pipeline {

/// The parameters that all jobs which train a network share; settings of the network itself are a
/// preset and overrides.
struct TrainingSpec {
  std::string name;           ///< of the model; empty: none is registered
  std::string data_artifact;  ///< "artifacts/<sha256>": the clips of the data set
  std::string data;           ///< its name, for the card
  std::string data_license;
  std::string action_class;  ///< "kick"; empty: all clips
  std::string hold_out;      ///< actor who is not learned from; empty: nobody
  std::string preset = "recommended";
  base::Overrides overrides;  ///< "set": settings by name

  /// The hash in data_artifact: the fingerprint of the data set.
  std::string DataFingerprint() const;
  /// "class kick, without actor tr".
  std::string TrainedOn() const;
  /// The preset of a family's config with the overrides. Errors: kInvalidArgument UNKNOWN_PRESET,
  /// those of ApplyOverrides and Config::Validate.
  template <typename Config>
  StatusOr<Config> ConfigOf() const {
    POISE_ASSIGN_OR_RETURN(Config config, Config::FromPreset(preset));
    POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
    POISE_RETURN_IF_ERROR(config.Validate());
    return config;
  }
};

/// Reads the shared parameters, and `more` that a kind has beside them, into `spec`.
/// Errors: kInvalidArgument UNKNOWN_CONFIG_KEY, MALFORMED_CONFIG_VALUE, CONFIG_VALUE_OUT_OF_RANGE,
/// BAD_MODEL_NAME, MISSING_DATA; the field is the parameter.
Status ReadTrainingSpec(base::Json parameters, std::vector<base::Field> more, TrainingSpec& spec);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAINING_SPEC_H_
