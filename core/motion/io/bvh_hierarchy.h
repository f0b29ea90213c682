#ifndef POISE_CORE_MOTION_IO_BVH_HIERARCHY_H_
#define POISE_CORE_MOTION_IO_BVH_HIERARCHY_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/io/text_scanner.h"
#include "core/motion/skeleton.h"

namespace poise::motion {

/// One number a frame that moves a joint.
struct BvhChannel {
  bool is_position = false;
  int axis = 0;  ///< 0 = x, 1 = y, 2 = z

  friend bool operator==(const BvhChannel&, const BvhChannel&) = default;
};

/// "Xposition", "Zrotation", in any case; nullopt for anything else.
std::optional<BvhChannel> ParseBvhChannel(std::string_view name);
std::string BvhChannelName(const BvhChannel& channel);

/// The HIERARCHY part of a BVH file, parents first, in the file's unit and axes.
/// Shapes:  channels (joints): the channels of each joint in the order of its columns
struct BvhHierarchy {
  std::vector<Joint> joints;
  std::vector<std::vector<BvhChannel>> channels;
  int num_columns = 0;             ///< numbers in a frame
  std::vector<std::string> notes;  ///< what was left out
};

/// Reads up to and including the word MOTION. Joints may have any number of channels, none
/// included; names reach to the end of their line. A joint's second End Site is left out (and
/// noted): nothing moves with it. Errors: kInvalidArgument MALFORMED_BVH, DUPLICATE_JOINT,
/// TOO_LARGE, each with the line.
StatusOr<BvhHierarchy> ReadBvhHierarchy(TextScanner& scanner);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_BVH_HIERARCHY_H_
