#ifndef POISE_CORE_MOTION_IO_CLIP_FILE_H_
#define POISE_CORE_MOTION_IO_CLIP_FILE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/motion/clip.h"

namespace poise::motion {

enum class ClipFormat { kUnknown, kBvh, kAmc, kNpz, kCmuText, kDeepMimic };
enum class UpAxis { kY, kZ };

/// "bvh", "amc", "npz", "cmu_text", "deepmimic_json", "unknown"
const char* ClipFormatName(ClipFormat format);
/// From a name as above. Errors: kInvalidArgument UNKNOWN_FORMAT.
StatusOr<ClipFormat> ParseClipFormat(std::string_view name);
/// From the file name's ending and the first bytes; kUnknown when neither tells.
ClipFormat DetectClipFormat(std::string_view file_name, std::string_view data);

/// What files do not say. A value given here overrides what would be detected from the body's size.
struct ClipHints {
  std::optional<double> unit_m = {};      ///< [m > 0] length of one file unit
  std::optional<UpAxis> up = {};          ///< axis that points up in the file
  std::optional<double> frame_rate = {};  ///< [Hz]
};

/// How the file wrote the motion, kept so that it can be written back unchanged.
struct SourceConvention {
  ClipFormat format = ClipFormat::kUnknown;
  double unit_m = 1.0;
  UpAxis up = UpAxis::kY;
  /// True when the rest pose stands along `up` too (then offsets and all rotations were turned, not
  /// the root's only).
  bool rest_pose_turned = false;
  /// Per joint: its channels in the file's order ("Xposition", ...). Empty: Zrotation Xrotation
  /// Yrotation, after three positions for the root.
  std::vector<std::vector<std::string>> channels = {};
  /// What was detected and why, a sentence each: "unit: 0.01 m, since the body would be 1.68 tall".
  std::vector<std::string> notes = {};
};

/// How most BVH files are written: in centimetres, Y up, channels Z X Y.
SourceConvention UsualBvhConvention();

/// A clip as read, in Poise's conventions (metres, Y up), with where it came from.
struct ClipFile {
  Clip clip;
  SourceConvention convention;
};

/// Reads a clip from memory. `name` is for messages ("kick.bvh") and becomes the clip's name
/// without its ending. `skeleton_data` is the ASF text that an AMC needs. Errors: kInvalidArgument
/// with the line (text) or entry (npz) and what was expected: UNKNOWN_FORMAT, MALFORMED_BVH,
/// MALFORMED_ASF, MALFORMED_AMC, MALFORMED_NPZ, MALFORMED_CMU_TEXT, MALFORMED_DEEPMIMIC, TOO_LARGE,
/// MOVING_JOINT_OFFSET (a BVH joint below the root chain that travels), MISSING_SKELETON, BAD_HINT,
/// and those of Skeleton and Clip.
StatusOr<ClipFile> DecodeClip(std::string_view name, std::string_view data,
                              ClipFormat format = ClipFormat::kUnknown, const ClipHints& hints = {},
                              std::string_view skeleton_data = "");

/// Reads a file; for an AMC finds its skeleton: `skeleton` if given, else HDM_<actor>.asf (the
/// longest name prefix) beside it, else in a `skeletons/` folder beside its own folder.
/// Errors: kNotFound FILE_NOT_FOUND, and those of DecodeClip.
StatusOr<ClipFile> ReadClipFile(const std::filesystem::path& path, const ClipHints& hints = {},
                                const std::filesystem::path& skeleton = {});

/// BVH text of a clip in the convention of its source, or in the usual one. Joints stand depth
/// first, as the format has them: a skeleton in another order comes back in this one.
std::string EncodeBvh(const Clip& clip, const SourceConvention& convention = UsualBvhConvention());

/// Errors: kFailedPrecondition CANNOT_WRITE.
Status WriteBvhFile(const std::filesystem::path& path, const Clip& clip,
                    const SourceConvention& convention = UsualBvhConvention());

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_CLIP_FILE_H_
