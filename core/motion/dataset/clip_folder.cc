#include "core/motion/dataset/clip_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "core/motion/editing/retarget.h"

namespace poise::motion {
namespace {

namespace fs = std::filesystem;

struct Body {
  Clip clip;
  JointRoles roles;
};

bool IsMotionFile(const fs::path& path) {
  static const std::set<std::string> endings = {".bvh", ".amc", ".npz", ".txt", ".json"};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return endings.contains(ending);
}

ClipLabels LabelsOfFile(const fs::path& path, const fs::path& folder) {
  ClipLabels labels = LabelsOf(path.stem().string());
  const fs::path parent = path.parent_path();
  if (labels.action.empty() && parent != folder) labels.action = parent.filename().string();
  return labels;
}

StatusOr<std::vector<fs::path>> MotionFiles(const fs::path& folder,
                                            const ClipFolderOptions& options) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return base::NotFound("FOLDER_NOT_FOUND", "folder",
                          fmt::format("there is no folder '{}'", folder.string()));
  }
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!entry->is_regular_file() || !IsMotionFile(entry->path())) continue;
    const std::string action = LabelsOfFile(entry->path(), folder).action;
    if (options.action_class.empty() || IsOfClass(action, options.action_class)) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  if (!files.empty()) return files;
  return base::NotFound(
      "NO_CLIPS", "folder",
      fmt::format(
          "no motion files{} below '{}'",
          options.action_class.empty() ? "" : fmt::format(" of class '{}'", options.action_class),
          folder.string()));
}

StatusOr<Body> ReadBody(const fs::path& path, const ClipFolderOptions& options) {
  POISE_ASSIGN_OR_RETURN(ClipFile file, ReadClipFile(path, options.hints));
  POISE_ASSIGN_OR_RETURN(JointRoles roles,
                         JointRoles::Detect(*file.clip.skeleton(), options.joint_roles));
  POISE_RETURN_IF_ERROR(roles.RequireComplete());
  return Body{std::move(file.clip), std::move(roles)};
}

}  // namespace

StatusOr<ClipSet> ReadClipFolder(const fs::path& folder, const ClipFolderOptions& options) {
  POISE_ASSIGN_OR_RETURN(const std::vector<fs::path> files, MotionFiles(folder, options));
  ClipSet set{.clips = {}, .license = options.license, .notes = {}};
  std::optional<Body> target;
  if (!options.retarget_to.empty()) {
    POISE_ASSIGN_OR_RETURN(target, ReadBody(options.retarget_to, options));
    set.notes.push_back(
        fmt::format("retargeted to the body of {}", options.retarget_to.filename().string()));
  }
  for (const fs::path& path : files) {
    const auto named = [&](const Status& status) {
      return base::Annotate(status, fmt::format("'{}'", path.string()));
    };
    StatusOr<Body> body = ReadBody(path, options);
    if (!body.ok()) return named(body.status());
    if (target) {
      StatusOr<Clip> clip = Retarget(body->clip, body->roles, target->clip.skeleton(),
                                     target->roles, {.target_reference = &target->clip});
      if (!clip.ok()) return named(clip.status());
      body->clip = *std::move(clip);
    }
    ClipLabels labels = LabelsOfFile(path, folder);
    set.clips.push_back({std::move(labels.action), std::move(labels.actor), std::move(body->clip)});
  }
  return set;
}

}  // namespace poise::motion
