#ifndef POISE_CORE_MOTION_IO_AMC_READER_H_
#define POISE_CORE_MOTION_IO_AMC_READER_H_

#include "core/motion/io/asf_reader.h"
#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// Reads an AMC file with the skeleton it belongs to. A bone's rotation is C M C^-1 with C its axis
/// and M its angles; bones without degrees of freedom stay as they are. The rate is the `_120` at
/// the end of the file's name, else 120 Hz, the rate of HDM05 and CMU.
/// Errors: kInvalidArgument MALFORMED_AMC, TOO_LARGE, MOVING_JOINT_OFFSET (a bone that stretches),
/// with the line.
StatusOr<RawClip> ReadAmc(std::string_view file, std::string_view data, const AsfSkeleton& asf);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_AMC_READER_H_
