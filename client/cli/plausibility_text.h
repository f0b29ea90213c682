#ifndef POISE_CLIENT_CLI_PLAUSIBILITY_TEXT_H_
#define POISE_CLIENT_CLI_PLAUSIBILITY_TEXT_H_

#include <span>
#include <string>

#include "core/motion/metrics/plausibility.h"

namespace poise::cli {

/// One field of Plausibility, as a person reads it.
struct Measure {
  const char* label;  ///< in a list: "foot skate"
  const char* head;   ///< above a narrow column: "accel."
  double motion::Plausibility::*value;
  double scale;      ///< from the field's unit to `unit`
  const char* unit;  ///< "cm"
  int decimals;

  /// "3.1 cm"
  std::string Text(const motion::Plausibility& plausibility) const;
};

/// All of them, in the order of the struct.
std::span<const Measure> Measures();

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_PLAUSIBILITY_TEXT_H_
