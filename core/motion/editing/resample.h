#ifndef POISE_CORE_MOTION_EDITING_RESAMPLE_H_
#define POISE_CORE_MOTION_EDITING_RESAMPLE_H_

#include "core/motion/clip.h"

/// New frames between the old ones: root positions by linear, rotations by spherical interpolation
/// (shortest path). The first and the last pose are kept bit for bit, and so is every new frame
/// that falls on an old one; nothing is low-pass filtered (MotionAug sec. 1.5 decimates without a
/// filter).
namespace poise::motion {

/// The same motion at another rate. The last pose is kept, so the time between two frames is
/// duration / (frames - 1): it differs from 1 / frame_rate by up to half a frame over the whole
/// clip where the duration is no multiple of it.
/// Errors: kInvalidArgument BAD_FRAME_RATE, TOO_MANY_FRAMES.
StatusOr<Clip> Resample(const Clip& clip, double frame_rate);

/// The whole motion in `num_frames` frames at the clip's own rate: a time warp, slower or faster.
/// Errors: kInvalidArgument BAD_FRAME_COUNT (below 1, or 1 frame of a longer clip),
/// TOO_MANY_FRAMES.
StatusOr<Clip> ResampleToFrames(const Clip& clip, int num_frames);

/// The same for a duration [s, from first to last frame], to the nearest whole frame.
/// Errors: kInvalidArgument BAD_DURATION, and those of ResampleToFrames.
StatusOr<Clip> ResampleToDuration(const Clip& clip, double duration);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_EDITING_RESAMPLE_H_
