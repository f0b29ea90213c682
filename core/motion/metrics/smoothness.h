#ifndef POISE_CORE_MOTION_METRICS_SMOOTHNESS_H_
#define POISE_CORE_MOTION_METRICS_SMOOTHNESS_H_

#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::motion {

/// Root mean square, over joints and frames, of the length of a joint's acceleration [m/s^2] and
/// jerk [m/s^3] in the world: second and third central differences of positions (the latter at half
/// frames, from four neighbours). Preconditions: at least 3 and 4 frames.
double AccelerationRms(const WorldPoses& world, double frame_rate);
double JerkRms(const WorldPoses& world, double frame_rate);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_METRICS_SMOOTHNESS_H_
