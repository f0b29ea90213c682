#include "core/runtime/jobs/sqlite_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace poise::jobs::sqlite {

namespace fs = std::filesystem;

bool IsNetworkFileSystem(int64_t statfs_type) {
  // NFS, SMB, CIFS, SMB2, Lustre, 9p: linux/magic.h and Lustre's own.
  constexpr std::array<int64_t, 6> kTypes = {0x6969,     0x517b,     0xff534d42,
                                             0xfe534d42, 0x0bd00bd0, 0x01021997};
  return std::find(kTypes.begin(), kTypes.end(), statfs_type) != kTypes.end();
}

StatusOr<FileOwnership> FileOwnership::Take(const fs::path& path) {
  // A link and what it points to are one file, with one lock.
  std::error_code error;
  fs::path file = fs::weakly_canonical(path, error);
  if (error || !file.has_parent_path()) file = fs::path(".") / path;
  const fs::path folder = file.parent_path();
  fs::create_directories(folder, error);
  struct statfs system {};
  if (!error && statfs(folder.c_str(), &system) == 0 && IsNetworkFileSystem(system.f_type)) {
    return base::FailedPrecondition(
        "STORE_ON_NETWORK", "data_dir",
        fmt::format("'{}' is on a network file system, where SQLite's locks do not hold: use a "
                    "local disk",
                    folder.string()));
  }
  const std::string name = file.string() + ".lock";
  const int descriptor = error ? -1 : open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    return base::FailedPrecondition(
        "BAD_DATA_DIR", "data_dir",
        fmt::format("cannot write '{}': {}", name,
                    error ? error.message() : std::string(std::strerror(errno))));
  }
  FileOwnership ownership(descriptor);
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return base::FailedPrecondition(
        "STORE_IN_USE", "data_dir",
        fmt::format("another process uses the job store '{}'", file.string()));
  }
  return ownership;
}

FileOwnership::FileOwnership(FileOwnership&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileOwnership::~FileOwnership() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace poise::jobs::sqlite
