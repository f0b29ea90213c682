#include "client/cli/plausibility_text.h"

#include <fmt/format.h>

namespace poise::cli {
namespace {

using motion::Plausibility;

constexpr Measure kMeasures[] = {
    {"foot skate", "foot skate", &Plausibility::foot_skate_mps, 100, "cm/s", 1},
    {"penetration", "penetr.", &Plausibility::penetration_mean_m, 100, "cm", 2},
    {"penetration max", "penetr. max", &Plausibility::penetration_max_m, 100, "cm", 2},
    {"float", "float", &Plausibility::float_mean_m, 100, "cm", 2},
    {"self-penetration", "self-penetr.", &Plausibility::self_penetration_max_m, 100, "cm", 2},
    {"acceleration", "accel.", &Plausibility::acceleration_rms_mps2, 1, "m/s²", 2},
    {"jerk", "jerk", &Plausibility::jerk_rms_mps3, 1, "m/s³", 0},
};

}  // namespace

std::string Measure::Text(const Plausibility& plausibility) const {
  return fmt::format("{:.{}f} {}", plausibility.*value * scale, decimals, unit);
}

std::span<const Measure> Measures() { return kMeasures; }

}  // namespace poise::cli
