#ifndef POISE_CLIENT_CLI_CLIP_INPUT_H_
#define POISE_CLIENT_CLI_CLIP_INPUT_H_

#include <filesystem>
#include <string>

#include "CLI/CLI.hpp"
#include "core/base/status.h"
#include "core/motion/io/clip_file.h"
#include "core/motion/joint_roles.h"

namespace poise::cli {

/// The flags that every command which reads motion files has; empty means: detect.
struct ReaderFlags {
  std::string unit;    ///< "cm" or a number of metres
  std::string up;      ///< "y" or "z"
  std::string fps;     ///< frames per second
  std::string asf;     ///< skeleton file of an AMC
  std::string roles;   ///< JSON file that maps joints by hand
  std::string format;  ///< "bvh", ...
};

/// Declares --unit, --up, --fps, --asf, --roles and --format.
void AddReaderFlags(CLI::App& app, ReaderFlags& flags);

/// A motion file with the roles of its joints; `role_overrides` is what --roles says.
struct LoadedClip {
  motion::ClipFile file;
  motion::JointRoles roles;
  motion::RoleOverrides role_overrides;
};

/// Errors: those of the readers (core/motion/io/clip_file.h) and of --roles; BAD_UNIT, BAD_UP_AXIS,
/// BAD_FRAME_RATE with the flag as the field.
StatusOr<LoadedClip> LoadClip(const std::filesystem::path& path, const ReaderFlags& flags);

/// Metres from "m", "cm", "mm", "inch" or a positive number; `flag` names it in errors.
StatusOr<double> ParseUnit(const std::string& text, const std::string& flag);
/// From "y" or "z".
StatusOr<motion::UpAxis> ParseUpAxis(const std::string& text, const std::string& flag);
const char* UpAxisName(motion::UpAxis up);
/// A rate in frames per second, in (0, 10000].
StatusOr<double> ParseFrameRate(const std::string& text, const std::string& flag);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_CLIP_INPUT_H_
