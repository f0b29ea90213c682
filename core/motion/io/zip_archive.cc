#include "core/motion/io/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>

#include "core/motion/io/text_scanner.h"

namespace poise::motion {
namespace {

constexpr size_t kChunk = 1 << 20;

Status Malformed(std::string_view where, std::string_view problem) {
  return base::InvalidArgument("MALFORMED_NPZ", "", fmt::format("{}: {}", where, problem));
}

struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

}  // namespace

struct ZipArchive::Handle {
  zip_t* zip = nullptr;

  ~Handle() {
    if (zip != nullptr) zip_discard(zip);
  }
};

ZipArchive::ZipArchive(std::string_view file, std::unique_ptr<Handle> handle)
    : file_(file), handle_(std::move(handle)) {}
ZipArchive::ZipArchive(ZipArchive&&) noexcept = default;
ZipArchive& ZipArchive::operator=(ZipArchive&&) noexcept = default;
ZipArchive::~ZipArchive() = default;

StatusOr<ZipArchive> ZipArchive::Open(std::string_view file, std::string_view data) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(data.data(), data.size(), 0, &error);
  auto handle = std::make_unique<Handle>();
  if (source != nullptr) handle->zip = zip_open_from_source(source, ZIP_RDONLY, &error);
  if (handle->zip == nullptr) {
    const std::string why = zip_error_strerror(&error);
    if (source != nullptr) zip_source_free(source);
    zip_error_fini(&error);
    return Malformed(file, fmt::format("expected a zip archive, found none that opens ({})", why));
  }
  zip_error_fini(&error);
  return ZipArchive(file, std::move(handle));
}

StatusOr<std::optional<std::string>> ZipArchive::Read(std::string_view entry) const {
  const std::string name(entry);
  const std::string where = fmt::format("{}: entry {}", file_, Quoted(entry));
  const zip_int64_t index = zip_name_locate(handle_->zip, name.c_str(), 0);
  if (index < 0) return std::nullopt;
  zip_stat_t stat;
  if (zip_stat_index(handle_->zip, index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0) {
    return Malformed(where, "expected an entry of known size");
  }
  if (stat.size > kMostEntryBytes) {
    return base::InvalidArgument("TOO_LARGE", "",
                                 fmt::format("{}: unpacks to {} bytes, expected at most {}", where,
                                             stat.size, kMostEntryBytes));
  }
  const std::unique_ptr<zip_file_t, CloseEntry> opened(zip_fopen_index(handle_->zip, index, 0));
  if (opened == nullptr) {
    return Malformed(
        where, fmt::format("expected a stored or deflated entry: {}", zip_strerror(handle_->zip)));
  }
  // By chunks: the size that the archive states may be a lie, in both directions.
  std::string bytes;
  while (bytes.size() <= stat.size) {
    const size_t before = bytes.size();
    const size_t wanted = std::min<size_t>(kChunk, stat.size - before + 1);
    bytes.resize(before + wanted);
    const zip_int64_t count = zip_fread(opened.get(), bytes.data() + before, wanted);
    bytes.resize(before + std::max<zip_int64_t>(count, 0));
    if (count < 0) {
      return Malformed(where, fmt::format("expected intact data, found damage after {} bytes: {}",
                                          before, zip_file_strerror(opened.get())));
    }
    if (count == 0) break;
  }
  if (bytes.size() != stat.size) {
    return Malformed(where, fmt::format("expected {} bytes as the archive says, found {}",
                                        stat.size, bytes.size() < stat.size ? "fewer" : "more"));
  }
  return bytes;
}

}  // namespace poise::motion
