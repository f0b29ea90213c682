#ifndef POISE_CORE_PIPELINE_SETTINGS_OF_SPEC_H_
#define POISE_CORE_PIPELINE_SETTINGS_OF_SPEC_H_

#include "core/base/config_fields.h"
#include "core/base/json.h"
#include "core/base/status.h"

namespace poise::pipeline {

/// Takes the object "set" out of a job's parameters: settings of a config by name.
/// Errors: kInvalidArgument MALFORMED_CONFIG_VALUE with the field "set".
StatusOr<base::Overrides> TakeSettings(base::Json& parameters);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_SETTINGS_OF_SPEC_H_
