#ifndef POISE_CORE_PUSH_PRESETS_CHECK_PRESET_H_
#define POISE_CORE_PUSH_PRESETS_CHECK_PRESET_H_

#include <string>

#include "core/base/config_fields.h"
#include "core/base/status.h"

namespace poise::push {

/// The settings of a preset with overrides, of a config that knows it.
/// Errors: kInvalidArgument UNKNOWN_PRESET, those of ApplyOverrides and Config::Validate.
template <typename Config>
StatusOr<Config> ConfigOf(const std::string& preset, const base::Overrides& overrides) {
  POISE_ASSIGN_OR_RETURN(Config config, Config::FromPreset(preset));
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  return config;
}

/// Whether a push model could be trained so; without LibTorch. Errors: those of ConfigOf.
Status CheckPreset(const std::string& preset, const base::Overrides& overrides);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_PRESETS_CHECK_PRESET_H_
