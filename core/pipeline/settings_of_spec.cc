#include "core/pipeline/settings_of_spec.h"

namespace poise::pipeline {

StatusOr<base::Overrides> TakeSettings(base::Json& parameters) {
  constexpr const char* kKey = "set";
  base::Overrides settings;
  if (!parameters.is_object() || !parameters.contains(kKey)) return settings;
  const base::Json object = parameters[kKey];
  parameters.erase(kKey);
  if (!object.is_object()) {
    return base::InvalidArgument("MALFORMED_CONFIG_VALUE", kKey,
                                 "'set' expects an object of settings");
  }
  for (const auto& [key, value] : object.items()) {
    settings[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return settings;
}

}  // namespace poise::pipeline
