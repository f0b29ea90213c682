#ifndef POISE_CORE_MOTION_IO_NPZ_READER_H_
#define POISE_CORE_MOTION_IO_NPZ_READER_H_

#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// Reads a motion of the AMASS style: a zip of NumPy arrays, metres, Z up.
/// Shapes:  poses (frames, at least 66): rotation vectors, of which the 22 body joints are read;
///          trans (frames, 3); mocap_framerate or mocap_frame_rate: one number
/// The body is the default one of `smpl_skeleton.h`: `betas` (shape) need the licensed body model.
/// `trans` is taken for the pelvis's position, from which it differs by a constant of the model.
/// Errors: kInvalidArgument MALFORMED_NPZ, TOO_LARGE, with the entry.
StatusOr<RawClip> ReadNpz(std::string_view file, std::string_view data);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_NPZ_READER_H_
