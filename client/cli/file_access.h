#ifndef POISE_CLIENT_CLI_FILE_ACCESS_H_
#define POISE_CLIENT_CLI_FILE_ACCESS_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::cli {

/// The whole file. Errors: kNotFound FILE_NOT_FOUND.
StatusOr<std::string> ReadFile(const std::filesystem::path& path);

/// Errors: kFailedPrecondition CANNOT_WRITE, with the reason that the system gives.
Status WriteFile(const std::filesystem::path& path, std::string_view data);
Status MakeFolder(const std::filesystem::path& path);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_FILE_ACCESS_H_
