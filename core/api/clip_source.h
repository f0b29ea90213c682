#ifndef POISE_CORE_API_CLIP_SOURCE_H_
#define POISE_CORE_API_CLIP_SOURCE_H_

#include <string>
#include <variant>

#include "core/motion/clip.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/joint_roles.h"

namespace poise::api {

/// A motion file as bytes, for clients without a parser.
struct EncodedClip {
  std::string name;  ///< file name, for messages and format detection
  std::string data;
  motion::ClipFormat format = motion::ClipFormat::kUnknown;  ///< kUnknown = detect
  std::string skeleton_data;                                 ///< ASF text, for AMC only
  motion::ClipHints hints;
};

/// A motion file that was uploaded before: `artifact` is "artifacts/<sha256>".
struct StoredClip {
  std::string artifact;
  std::string name;
  motion::ClipFormat format = motion::ClipFormat::kUnknown;
  std::string skeleton_data;
  motion::ClipHints hints;
};

/// A clip as a caller hands it over, with the joint roles that it maps by hand.
struct ClipSource {
  std::variant<motion::Clip, EncodedClip, StoredClip> clip;
  motion::RoleOverrides joint_roles;
};

}  // namespace poise::api

#endif  // POISE_CORE_API_CLIP_SOURCE_H_
