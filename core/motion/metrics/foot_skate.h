#ifndef POISE_CORE_MOTION_METRICS_FOOT_SKATE_H_
#define POISE_CORE_MOTION_METRICS_FOOT_SKATE_H_

#include <span>

#include "core/motion/metrics/positions_view.h"

/// Feet that slide while they stand, measured on joints alone, so that a predicted motion can be
/// held against a recorded one with the same thresholds.
namespace poise::motion {

/// Which joints are feet, and which coordinate points up from the floor at 0.
struct FootJoints {
  std::span<const int> joints;
  int up = 1;
};

/// FSE [m/s]: mean horizontal speed since the frame before, weighted by 2 - 2^(h / H), over the
/// feet and frames (from the second) with height h <= H = `height_m`; 0 when no foot is that low.
/// Source: the measure of motion VAEs; the paper on pushes states no threshold (push.md sec. 10).
double FootSkateError(const PositionsView& motion, const FootJoints& feet, double height_m,
                      double frame_rate);

/// Share of frames in which at least one foot is at `height_m` or lower. A motion that lifts its
/// feet escapes FootSkateError, and shows here.
double ContactShare(const PositionsView& motion, const FootJoints& feet, double height_m);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_FOOT_SKATE_H_
