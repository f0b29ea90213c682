#ifndef POISE_CORE_MOTION_METRICS_BONE_LENGTH_H_
#define POISE_CORE_MOTION_METRICS_BONE_LENGTH_H_

#include <span>

#include "core/motion/metrics/positions_view.h"

namespace poise::motion {

/// Mean, over frames and bones, of the difference between a bone's length in two motions [m].
/// `parents` has a joint's parent, or -1. Preconditions: both of one shape, at least one frame.
double BoneLengthError(const PositionsView& found, const PositionsView& truth,
                       std::span<const int> parents);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_BONE_LENGTH_H_
