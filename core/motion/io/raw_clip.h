#ifndef POISE_CORE_MOTION_IO_RAW_CLIP_H_
#define POISE_CORE_MOTION_IO_RAW_CLIP_H_

#include <optional>
#include <string>
#include <vector>

#include "core/motion/io/clip_file.h"

namespace poise::motion {

/// What a reader takes from a file: the motion in the file's own unit and axes, and what the file
/// or its format says about them. `ToClipFile` makes a clip of it.
/// Shapes:  root_positions (frames, 3); rotations (frames, joints), frame by frame
struct RawClip {
  /// A quantity that the format fixes, and how it does so ("the ASF says length 0.45").
  template <typename T>
  struct Stated {
    T value;
    std::string why;
  };

  std::vector<Joint> joints;
  std::vector<Vec3> root_positions;
  std::vector<Quat> rotations;
  std::vector<std::vector<std::string>> channels;  ///< as in SourceConvention
  std::optional<Stated<double>> unit_m;
  std::optional<Stated<UpAxis>> up;
  Stated<double> frame_rate{0, ""};  ///< [Hz]
  std::vector<std::string> notes;
};

/// Most rotations (frames x joints) that a file of so many bytes may unfold to: a few bytes must
/// not fill the memory through joints that have no channels.
int64_t MostRotations(size_t file_bytes);

/// Errors: TOO_LARGE, naming the file, its line (0: it has none) and the limit.
Status CheckSize(std::string_view file, int line, int64_t frames, int64_t joints,
                 size_t file_bytes);

/// The clip in metres with Y up: what the file does not state and no hint gives is detected from
/// the body (`convention_detection.h`). A file with Z up is turned by (x, y, z) -> (x, z, -y): all
/// of it where the rest pose stands along Z as well, else the root only.
/// Errors: kInvalidArgument BAD_HINT, and those of Skeleton and Clip.
StatusOr<ClipFile> ToClipFile(std::string_view file, RawClip raw, ClipFormat format,
                              const ClipHints& hints);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_RAW_CLIP_H_
