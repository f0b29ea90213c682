#ifndef POISE_CORE_MOTION_METRICS_ADE_FDE_H_
#define POISE_CORE_MOTION_METRICS_ADE_FDE_H_

#include "core/motion/metrics/positions_view.h"

namespace poise::motion {

/// How far one joint's path is from the true one [m].
struct DisplacementError {
  double average = 0;  ///< ADE: mean over frames
  double final = 0;    ///< FDE: in the last frame
};

/// Preconditions: both of one shape, at least one frame.
DisplacementError PathError(const PositionsView& found, const PositionsView& truth, int joint);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_ADE_FDE_H_
