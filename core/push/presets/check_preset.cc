#include "core/push/presets/check_preset.h"

#include <fmt/format.h>

#include "core/push/ldp/ldp_config.h"
#include "core/push/training/push_training_config.h"

namespace poise::push {

Status CheckPreset(const std::string& preset, const base::Overrides& overrides) {
  if (preset == ldp::kPreset) return ConfigOf<ldp::LdpTraining>(preset, overrides).status();
  const Status status = ConfigOf<PushTraining>(preset, overrides).status();
  if (base::ErrorReason(status) != "UNKNOWN_PRESET") return status;
  return base::InvalidArgument(
      "UNKNOWN_PRESET", "preset",
      fmt::format("unknown preset '{}', expected recommended or {}", preset, ldp::kPreset));
}

}  // namespace poise::push
