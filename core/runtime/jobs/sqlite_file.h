#ifndef POISE_CORE_RUNTIME_JOBS_SQLITE_FILE_H_
#define POISE_CORE_RUNTIME_JOBS_SQLITE_FILE_H_

#include <cstdint>
#include <filesystem>

#include "core/base/status.h"

namespace poise::jobs::sqlite {

/// Holds a database file for this process, by a lock on FILE.lock; the kernel frees it when the
/// process ends, however it does.
class FileOwnership {
 public:
  /// Makes the folder if it is not there.
  /// Errors: kFailedPrecondition BAD_DATA_DIR, STORE_IN_USE, STORE_ON_NETWORK.
  static StatusOr<FileOwnership> Take(const std::filesystem::path& path);
  FileOwnership(FileOwnership&& other) noexcept;
  FileOwnership& operator=(FileOwnership&&) = delete;
  ~FileOwnership();

 private:
  explicit FileOwnership(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

/// Whether statfs names a file system on which locks or shared memory do not hold: NFS, SMB, CIFS,
/// Lustre, 9p.
bool IsNetworkFileSystem(int64_t statfs_type);

}  // namespace poise::jobs::sqlite

#endif  // POISE_CORE_RUNTIME_JOBS_SQLITE_FILE_H_
