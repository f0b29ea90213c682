#ifndef POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_
#define POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_

#include <string>

#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/base/status.h"
#include "core/synthesis/vae/vae_config.h"

namespace poise::pipeline {

/// The parameters of a job of kind `train_vae`.
struct TrainVaeSpec {
  std::string name;           ///< of the model; empty: none is registered
  std::string data_artifact;  ///< "artifacts/<sha256>": the clips of the data set
  std::string data;           ///< its name, for the card
  std::string data_license;
  std::string action_class;  ///< "kick"; empty: all clips
  std::string hold_out;      ///< actor who is not learned from; empty: nobody
  std::string preset = "recommended";
  base::Overrides overrides;  ///< "set": settings of VaeConfig by name

  /// Errors: kInvalidArgument with a field below "spec.parameters": UNKNOWN_CONFIG_KEY,
  /// MALFORMED_CONFIG_VALUE, BAD_MODEL_NAME, MISSING_DATA, UNKNOWN_PRESET,
  /// CONFIG_VALUE_OUT_OF_RANGE.
  static StatusOr<TrainVaeSpec> FromParameters(const base::Json& parameters);

  /// The preset with the overrides.
  StatusOr<synthesis::VaeConfig> Config() const;
};

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_VAE_SPEC_H_
