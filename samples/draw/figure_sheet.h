#ifndef POISE_SAMPLES_DRAW_FIGURE_SHEET_H_
#define POISE_SAMPLES_DRAW_FIGURE_SHEET_H_

#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/motion/clip.h"

namespace poise::samples {

/// What a sheet shows of its clips, seen from the performer's right.
struct SheetLayout {
  /// Each clip is a row of this many moments, evenly spaced.
  int moments = 11;
  /// Instead: all clips over each other in one row, as variants of one motion.
  bool overlay = false;
};

/// SVG of figures made of rounded limbs: right side red, left side blue. Any biped will do.
/// Errors: kFailedPrecondition MISSING_ROLES; kInvalidArgument EMPTY_SHEET (no clips, no moments).
StatusOr<std::string> DrawSheet(const std::vector<motion::Clip>& clips, const SheetLayout& layout);

}  // namespace poise::samples

#endif  // POISE_SAMPLES_DRAW_FIGURE_SHEET_H_
