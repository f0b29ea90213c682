#ifndef POISE_CORE_MOTION_METRICS_MPJPE_H_
#define POISE_CORE_MOTION_METRICS_MPJPE_H_

#include "core/motion/metrics/positions_view.h"

/// Mean per joint position error [m]: the distance between a joint's place in two motions, averaged
/// over frames and joints. Preconditions: both of one shape, at least one frame.
namespace poise::motion {

/// In the world, nothing aligned.
double Mpjpe(const PositionsView& found, const PositionsView& truth);

/// With each frame moved so that the roots coincide: the error of the pose alone.
double RootAlignedMpjpe(const PositionsView& found, const PositionsView& truth, int root);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_MPJPE_H_
