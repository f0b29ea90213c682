#include "core/correction/correction_config.h"

namespace poise::correction {

StatusOr<CorrectionConfig> CorrectionConfig::FromPreset(std::string_view preset) {
  CorrectionConfig config;
  POISE_ASSIGN_OR_RETURN(config.humanoid, physics::HumanoidConfig::FromPreset(preset));
  POISE_ASSIGN_OR_RETURN(config.world, physics::WorldConfig::FromPreset(preset));
  POISE_ASSIGN_OR_RETURN(config.reference, ReferenceConfig::FromPreset(preset));
  POISE_ASSIGN_OR_RETURN(config.tracking, TrackingConfig::FromPreset(preset));
  POISE_ASSIGN_OR_RETURN(config.learning, LearningConfig::FromPreset(preset));
  if (preset == "paper") config.effort = "instant";
  return config;
}

std::vector<base::Field> CorrectionConfig::Fields() {
  std::vector<base::Field> fields = {base::Text("effort", &effort, {"instant", "fast"})};
  base::Append(fields, base::Nested("humanoid", humanoid.Fields()));
  base::Append(fields, base::Nested("world", world.Fields()));
  base::Append(fields, base::Nested("reference", reference.Fields()));
  base::Append(fields, base::Nested("tracking", tracking.Fields()));
  base::Append(fields, base::Nested("reward", reward.Fields()));
  base::Append(fields, base::Nested("learning", learning.Fields()));
  return fields;
}

}  // namespace poise::correction
