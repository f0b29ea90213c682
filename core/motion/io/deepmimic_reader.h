#ifndef POISE_CORE_MOTION_IO_DEEPMIMIC_READER_H_
#define POISE_CORE_MOTION_IO_DEEPMIMIC_READER_H_

#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// Reads a motion file of DeepMimic's humanoid (JSON): metres, Y up, facing +X, 15 joints named by
/// their roles. A clip has one rate: where the steps between frames differ, the motion is resampled
/// to the most common one (shortest-path slerp), and the notes say so. Quaternions are normalised.
/// Errors: kInvalidArgument MALFORMED_DEEPMIMIC, TOO_LARGE, with the frame.
StatusOr<RawClip> ReadDeepMimic(std::string_view file, std::string_view data);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_DEEPMIMIC_READER_H_
