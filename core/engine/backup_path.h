#ifndef POISE_CORE_ENGINE_BACKUP_PATH_H_
#define POISE_CORE_ENGINE_BACKUP_PATH_H_

#include <filesystem>
#include <string>

#include "core/base/status.h"

namespace poise::engine {

/// The absolute path that a caller means with one below the data folder, whose folders are made.
/// Whatever the caller writes, and whatever links are there, it stays below the data folder and
/// outside of what the server itself keeps in it.
/// Errors: kInvalidArgument BAD_BACKUP_PATH; kFailedPrecondition CANNOT_WRITE.
StatusOr<std::filesystem::path> BackUpPath(const std::filesystem::path& data_dir,
                                           const std::string& path);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_BACKUP_PATH_H_
