#include "core/engine/backup_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace poise::engine {
namespace {

namespace fs = std::filesystem;

Status BadPath(const std::string& path) {
  return base::InvalidArgument(
      "BAD_BACKUP_PATH", "path",
      fmt::format("'{}': expected a new file below the data folder, like 'backups/monday.db'",
                  path));
}

bool IsPlain(const std::string& text, const fs::path& path) {
  if (text.empty() || text.find('\0') != std::string::npos || path.is_absolute()) return false;
  return std::none_of(path.begin(), path.end(), [](const fs::path& part) {
    return part.empty() || part == "." || part == "..";
  });
}

// What the server keeps: the artifacts, the store and the files beside it.
bool IsOurs(const fs::path& first) {
  return first == "artifacts" || first.string().starts_with("jobs.db");
}

bool IsBelow(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

StatusOr<fs::path> BackUpPath(const fs::path& data_dir, const std::string& path) {
  const fs::path relative(path);
  if (!IsPlain(path, relative)) return BadPath(path);
  std::error_code error;
  const fs::path root = fs::canonical(data_dir, error);
  // Follows the links of the part that exists.
  const fs::path full = error ? fs::path() : fs::weakly_canonical(root / relative, error);
  if (error || full == root || !IsBelow(full, root)) return BadPath(path);
  if (IsOurs(*full.lexically_relative(root).begin())) return BadPath(path);
  fs::create_directories(full.parent_path(), error);
  if (!error) return full;
  return base::FailedPrecondition(
      "CANNOT_WRITE", "path",
      fmt::format("cannot make the folder '{}': {}", full.parent_path().string(), error.message()));
}

}  // namespace poise::engine
