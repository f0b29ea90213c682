#ifndef POISE_CORE_MOTION_IO_BVH_READER_H_
#define POISE_CORE_MOTION_IO_BVH_READER_H_

#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// Reads a BVH file. A joint's rotation is the product of its rotation channels in their order.
///
/// Position channels replace OFFSET, they do not add to it (only where a joint's are all zero and
/// its OFFSET is not does the OFFSET stand). On inner joints:
/// - Constant ones (within 2e-4 of the body's size) are the bone's offset.
/// - Where the joints that travel lie on the one chain that leaves the root (Bandai-Namco's
///   `joint_Root`, `Hips`), the chain is folded: the last of them becomes the clip's root with its
///   world position and rotation, and the joints above it are gone.
/// - Any other joint that travels is refused.
/// Errors: kInvalidArgument MALFORMED_BVH, DUPLICATE_JOINT, TOO_LARGE, MOVING_JOINT_OFFSET, each
/// with the file's name and the line.
StatusOr<RawClip> ReadBvh(std::string_view file, std::string_view data);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_BVH_READER_H_
