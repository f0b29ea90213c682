#ifndef POISE_CORE_MOTION_EDITING_SAMPLE_AT_H_
#define POISE_CORE_MOTION_EDITING_SAMPLE_AT_H_

#include <span>

#include "core/motion/clip.h"

namespace poise::motion {

/// The poses of a clip at the given places between its frames (2.25: a quarter of the way from
/// frame 2 to frame 3), as a clip at `frame_rate`. Places within 1e-6 of a frame give that frame
/// bit for bit. Errors: kInvalidArgument BAD_FRAME_RANGE (a place outside the clip), NO_FRAMES,
/// BAD_FRAME_RATE.
StatusOr<Clip> SampleAt(const Clip& clip, std::span<const double> places, double frame_rate);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_SAMPLE_AT_H_
