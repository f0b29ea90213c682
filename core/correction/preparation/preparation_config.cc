#include "core/correction/preparation/preparation_config.h"

namespace poise::correction {

std::vector<base::Field> PreparationConfig::Fields() {
  return {
      base::Flag("enabled", &enabled),
      base::Number("height_band_m", &height_band_m, 0, 10),
      base::Number("height_cutoff_hz", &height_cutoff_hz, 0.1, 1000),
      base::Number("contact_height_m", &contact_height_m, 1e-4, 1),
      base::Number("contact_speed_mps", &contact_speed_mps, 1e-3, 100),
      base::Number("shortest_s", &shortest_s, 0, 10),
      base::Number("flat_angle", &flat_angle, 0, 1),
      base::Number("blend_s", &blend_s, 1e-3, 10),
      base::Number("glide_cutoff_hz", &glide_cutoff_hz, 0.1, 1000),
      base::Number("clearance_m", &clearance_m, 0, 1),
      base::Number("longest_drop_m", &longest_drop_m, 0, 1),
      base::Number("overlap_m", &overlap_m, 0, 1),
      base::Number("widest_turn", &widest_turn, 0, 1.5),
  };
}

}  // namespace poise::correction
