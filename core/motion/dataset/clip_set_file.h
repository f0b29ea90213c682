#ifndef POISE_CORE_MOTION_DATASET_CLIP_SET_FILE_H_
#define POISE_CORE_MOTION_DATASET_CLIP_SET_FILE_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/base/status.h"
#include "core/motion/dataset/labelled_clip.h"

namespace poise::motion {

/// Clips to learn from, as one thing that can be named, sent and kept.
struct ClipSet {
  std::vector<LabelledClip> clips;
  std::string license;             ///< as the user states it: "CC BY-SA 3.0"
  std::vector<std::string> notes;  ///< what was done to the files: "retargeted to ..."
};

/// One safetensors file (base/tensor_file.h): per clip `positions/<n>` (frames, 3) [m] and
/// `rotations/<n>` (frames, joints, 4) as w x y z, in single precision; the metadata "clip_set"
/// holds, as JSON, the skeletons and for each clip name, action, actor, skeleton and rate. The same
/// clips give the same bytes, so the hash of the file is the fingerprint of the set.
std::string EncodeClipSet(const ClipSet& set);

/// `what` names the bytes in messages. Errors: kInvalidArgument MALFORMED_CLIP_SET; those of
/// DecodeTensors, Skeleton::Create and Clip::Create.
StatusOr<ClipSet> DecodeClipSet(std::string_view bytes, std::string_view what);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_CLIP_SET_FILE_H_
