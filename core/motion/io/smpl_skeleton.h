#ifndef POISE_CORE_MOTION_IO_SMPL_SKELETON_H_
#define POISE_CORE_MOTION_IO_SMPL_SKELETON_H_

#include <vector>

#include "core/motion/skeleton.h"

namespace poise::motion {

inline constexpr int kNumSmplJoints = 22;

/// The 22 body joints of SMPL in its order, on a body of 1.70 m: files of the AMASS style hold
/// shape coefficients that only the licensed body model turns into bone lengths, so one body stands
/// for all. The lengths are rounded anthropometric values of an adult: thigh 0.40 m, shank 0.41,
/// spine from pelvis to neck 0.50, upper arm 0.27, forearm 0.26. T-pose, Y up, facing +Z, left at
/// +X.
std::vector<Joint> SmplJoints();

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_SMPL_SKELETON_H_
