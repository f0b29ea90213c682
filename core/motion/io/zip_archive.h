#ifndef POISE_CORE_MOTION_IO_ZIP_ARCHIVE_H_
#define POISE_CORE_MOTION_IO_ZIP_ARCHIVE_H_

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::motion {

/// A zip archive in memory (stored or deflated entries, zip64), for reading.
class ZipArchive {
 public:
  /// No entry may unfold to more: a few kilobytes of zip can hold gigabytes of zeros.
  static constexpr uint64_t kMostEntryBytes = 192 * 1024 * 1024;

  /// `data` must outlive the archive. Errors: kInvalidArgument MALFORMED_NPZ.
  static StatusOr<ZipArchive> Open(std::string_view file, std::string_view data);

  ZipArchive(ZipArchive&&) noexcept;
  ZipArchive& operator=(ZipArchive&&) noexcept;
  ~ZipArchive();

  /// The bytes of an entry, or nullopt when there is none of this name. Errors: MALFORMED_NPZ (the
  /// entry cannot be unpacked, or has another size than the archive says), TOO_LARGE.
  StatusOr<std::optional<std::string>> Read(std::string_view entry) const;

 private:
  struct Handle;
  ZipArchive(std::string_view file, std::unique_ptr<Handle> handle);

  std::string file_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_ZIP_ARCHIVE_H_
