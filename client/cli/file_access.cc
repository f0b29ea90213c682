#include "client/cli/file_access.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace poise::cli {
namespace {

Status CannotWrite(const std::filesystem::path& path, const std::string& why) {
  return base::FailedPrecondition("CANNOT_WRITE", "out",
                                  fmt::format("{}: cannot be written: {}", path.string(), why));
}

}  // namespace

StatusOr<std::string> ReadFile(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path, ignored)) {
    return base::NotFound("FILE_NOT_FOUND", "",
                          fmt::format("{}: no such file, or it cannot be read", path.string()));
  }
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

Status WriteFile(const std::filesystem::path& path, std::string_view data) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  stream.write(data.data(), static_cast<std::streamsize>(data.size()));
  stream.close();
  return stream ? absl::OkStatus() : CannotWrite(path, std::strerror(errno));
}

Status MakeFolder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  return error ? CannotWrite(path, error.message()) : absl::OkStatus();
}

}  // namespace poise::cli
