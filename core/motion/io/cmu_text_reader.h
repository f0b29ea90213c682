#ifndef POISE_CORE_MOTION_IO_CMU_TEXT_READER_H_
#define POISE_CORE_MOTION_IO_CMU_TEXT_READER_H_

#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// Numbers in a line: root position and 38 rotation vectors.
inline constexpr int kCmuTextColumns = 117;

/// Reads CMU motion as rotation-vector text, the form that prediction papers share: 117 decimals a
/// line, parted by commas. The vectors are those of the transposed matrices; the negated ones are
/// read. Seven of the 38 nodes are tips of bones: they become end sites, 31 joints remain. The file
/// has no bone lengths: one reference skeleton stands for all.
/// The first row is kept even where it is a T-pose (the notes say so).
/// Errors: kInvalidArgument MALFORMED_CMU_TEXT, TOO_LARGE, with the line.
StatusOr<RawClip> ReadCmuText(std::string_view file, std::string_view data);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_CMU_TEXT_READER_H_
