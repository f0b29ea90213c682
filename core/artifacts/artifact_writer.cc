#include "core/artifacts/artifact_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/artifacts/artifact_name.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

Status CannotStore(const fs::path& path) {
  const int error = errno;
  const std::string message =
      fmt::format("cannot write {}: {}", path.string(), std::strerror(error));
  if (error == ENOSPC || error == EDQUOT) {
    return base::ResourceExhausted("DISK_FULL", "", message);
  }
  return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "", message);
}

// A rename is durable only when the folder that holds the name is.
Status SyncFolder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return CannotStore(folder);
  const bool synced = fsync(descriptor) == 0;
  const Status status = synced ? absl::OkStatus() : CannotStore(folder);
  close(descriptor);
  return status;
}

}  // namespace

StatusOr<std::unique_ptr<ArtifactWriter>> ArtifactWriter::Create(const fs::path& root,
                                                                 int64_t max_bytes) {
  std::string staging = (root / "staging" / "upload-XXXXXX").string();
  const int file = mkostemp(staging.data(), O_CLOEXEC);
  if (file < 0) return CannotStore(staging);
  return std::unique_ptr<ArtifactWriter>(new ArtifactWriter(root, staging, file, max_bytes));
}

ArtifactWriter::~ArtifactWriter() {
  if (file_ >= 0) close(file_);
  if (!staging_.empty()) unlink(staging_.c_str());
}

Status ArtifactWriter::Append(std::string_view bytes) {
  if (static_cast<int64_t>(bytes.size()) > max_bytes_ - size_) {
    return base::InvalidArgument("TOO_LARGE", "chunk",
                                 fmt::format("the file is larger than {} bytes", max_bytes_));
  }
  digest_.Update(bytes);
  size_ += static_cast<int64_t>(bytes.size());
  while (!bytes.empty()) {
    const ssize_t written = write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return CannotStore(staging_);
    bytes.remove_prefix(written);
  }
  return absl::OkStatus();
}

StatusOr<ArtifactInfo> ArtifactWriter::Commit(std::string_view expected_sha256) {
  const std::string digest = digest_.HexDigest();
  if (!expected_sha256.empty() && expected_sha256 != digest) {
    return base::InvalidArgument("WRONG_DIGEST", "sha256",
                                 fmt::format("{} bytes arrived with SHA-256 {}, expected {}", size_,
                                             digest, expected_sha256.substr(0, digest.size())));
  }
  if (fsync(file_) != 0) return CannotStore(staging_);
  const fs::path folder = root_ / digest.substr(0, 2);
  std::error_code error;
  const bool made = fs::create_directory(folder, error);
  if (error) {
    errno = error.value();
    return CannotStore(folder);
  }
  // Renaming onto a file of the same content changes nothing that a reader could see.
  if (rename(staging_.c_str(), (folder / digest).c_str()) != 0) return CannotStore(folder);
  staging_.clear();
  POISE_RETURN_IF_ERROR(SyncFolder(folder));
  if (made) POISE_RETURN_IF_ERROR(SyncFolder(root_));
  return ArtifactInfo{ArtifactName(digest), size_};
}

}  // namespace poise::artifacts
