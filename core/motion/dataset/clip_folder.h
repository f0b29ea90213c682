#ifndef POISE_CORE_MOTION_DATASET_CLIP_FOLDER_H_
#define POISE_CORE_MOTION_DATASET_CLIP_FOLDER_H_

#include <filesystem>
#include <optional>
#include <string>

#include "core/base/status.h"
#include "core/motion/dataset/clip_set_file.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/joint_roles.h"

namespace poise::motion {

struct ClipFolderOptions {
  std::string license = {};
  /// Of the action (IsOfClass); empty: all.
  std::string action_class = {};
  /// A clip whose body all others are retargeted to (editing/retarget.h); empty: each keeps its
  /// own.
  std::filesystem::path retarget_to = {};
  RoleOverrides joint_roles = {};
  ClipHints hints = {};
};

/// Every motion file (bvh, amc, npz, txt, json) below a folder, in the order of their paths, read
/// and checked: it must have the required roles. Labels come from the file's name (LabelsOf), else
/// the action is the name of its folder.
/// Errors: kNotFound FOLDER_NOT_FOUND, NO_CLIPS; those of ReadClipFile, JointRoles and Retarget
/// with the file in the message.
StatusOr<ClipSet> ReadClipFolder(const std::filesystem::path& folder,
                                 const ClipFolderOptions& options);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_DATASET_CLIP_FOLDER_H_
