#ifndef POISE_CORE_PIPELINE_TRAIN_SPEC_H_
#define POISE_CORE_PIPELINE_TRAIN_SPEC_H_

#include <string>
#include <string_view>

#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/base/status.h"

namespace poise::pipeline {

/// The parameters of a job that trains a network on clips of a data set: kinds `train_vae`,
/// `train_debias`.
struct TrainSpec {
  std::string name;           ///< of the model; empty: none is registered
  std::string data_artifact;  ///< "artifacts/<sha256>": the clips of the data set
  std::string data;           ///< its name, for the card
  std::string data_license;
  std::string action_class;  ///< "kick"; empty: all clips
  std::string hold_out;      ///< actor who is not learned from; empty: nobody
  std::string preset = "recommended";
  base::Overrides overrides;  ///< "set": settings of the kind's config by name

  /// `kind` is for messages. Errors: kInvalidArgument with a field below "spec.parameters":
  /// UNKNOWN_CONFIG_KEY, MALFORMED_CONFIG_VALUE, BAD_MODEL_NAME, MISSING_DATA.
  static StatusOr<TrainSpec> FromParameters(const base::Json& parameters, std::string_view kind);

  /// The preset with the overrides, of synthesis::VaeConfig or correction::DebiasConfig.
  /// Errors: UNKNOWN_PRESET, UNKNOWN_CONFIG_KEY, CONFIG_VALUE_OUT_OF_RANGE, those of Validate.
  template <typename Config>
  StatusOr<Config> ConfigOf() const {
    POISE_ASSIGN_OR_RETURN(Config config, Config::FromPreset(preset));
    POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
    POISE_RETURN_IF_ERROR(config.Validate());
    return config;
  }
};

/// All that can be said of the parameters without the data. Errors: those of FromParameters and
/// ConfigOf, with a field below "spec.parameters".
Status CheckTrainVae(const base::Json& parameters);
Status CheckTrainDebias(const base::Json& parameters);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_SPEC_H_
