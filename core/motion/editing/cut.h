#ifndef POISE_CORE_MOTION_EDITING_CUT_H_
#define POISE_CORE_MOTION_EDITING_CUT_H_

#include "core/motion/clip.h"

namespace poise::motion {

/// `count` frames of the clip from frame `first` on.
/// Errors: kInvalidArgument BAD_FRAME_RANGE (empty, or not inside the clip).
StatusOr<Clip> Cut(const Clip& clip, int first, int count);

/// Frames 0, step, 2 step, ... at the frame rate divided by `step`: how data sets are thinned out,
/// without a filter and without the last frame where it is no multiple of `step` (Resample keeps
/// it). Errors: kInvalidArgument BAD_STEP (below 1).
StatusOr<Clip> TakeEvery(const Clip& clip, int step);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_CUT_H_
