#include "core/artifacts/artifact_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "core/artifacts/artifact_name.h"
#include "core/base/fail_point.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr size_t kBlockBytes = 1 << 20;

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

StatusOr<std::unique_ptr<ArtifactWriter>> ArtifactWriter::Create(const Place& place) {
  std::string staging = (place.root / "staging" / "upload-XXXXXX").string();
  const int file = mkostemp(staging.data(), O_CLOEXEC);
  if (file < 0) return CannotStore(staging);
  return std::unique_ptr<ArtifactWriter>(new ArtifactWriter(place, staging, file, std::nullopt));
}

StatusOr<std::unique_ptr<ArtifactWriter>> ArtifactWriter::Resume(const Place& place,
                                                                 const fs::path& file,
                                                                 UploadClaim claim,
                                                                 int64_t offset) {
  POISE_ASSIGN_OR_RETURN(const auto lock, claim.Lock());
  const int descriptor = open(file.c_str(), O_RDWR | O_CLOEXEC | (offset == 0 ? O_CREAT : 0), 0600);
  if (descriptor < 0 && errno != ENOENT) return CannotStore(file);
  struct stat info {};
  if (descriptor >= 0) fstat(descriptor, &info);
  if (offset < 0 || offset > info.st_size) {
    if (descriptor >= 0) close(descriptor);
    return base::FailedPrecondition(
        "WRONG_OFFSET", "offset",
        fmt::format("offset is {}, expected 0 to the {} bytes that have arrived", offset,
                    info.st_size));
  }
  std::unique_ptr<ArtifactWriter> writer(
      new ArtifactWriter(place, file, descriptor, std::move(claim)));
  POISE_RETURN_IF_ERROR(writer->ReadPrefix(offset));
  return writer;
}

Status ArtifactWriter::ReadPrefix(int64_t offset) {
  if (ftruncate(file_, offset) != 0) return CannotStore(staging_);
  std::vector<char> block(kBlockBytes);
  while (size_ < offset) {
    POISE_RETURN_IF_ERROR(claim_->Check());
    const ssize_t got = read(file_, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return CannotStore(staging_);
    digest_.Update({block.data(), static_cast<size_t>(got)});
    size_ += got;
  }
  return absl::OkStatus();
}

ArtifactWriter::~ArtifactWriter() {
  close(file_);
  if (!claim_ && !staging_.empty()) unlink(staging_.c_str());
}

StatusOr<std::unique_lock<std::mutex>> ArtifactWriter::LockUpload() const {
  if (!claim_) return std::unique_lock<std::mutex>();
  return claim_->Lock();
}

Status ArtifactWriter::Append(std::string_view bytes) {
  POISE_ASSIGN_OR_RETURN(const auto lock, LockUpload());
  if (static_cast<int64_t>(bytes.size()) > place_.max_bytes - size_) {
    if (claim_) unlink(staging_.c_str());
    return base::InvalidArgument("TOO_LARGE", "chunk",
                                 fmt::format("the file is larger than {} bytes", place_.max_bytes));
  }
  digest_.Update(bytes);
  size_ += static_cast<int64_t>(bytes.size());
  while (!bytes.empty()) {
    const ssize_t written = write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return CannotStore(staging_);
    bytes.remove_prefix(written);
  }
  base::FailPoint("artifacts.after_append");
  return absl::OkStatus();
}

StatusOr<ArtifactInfo> ArtifactWriter::Commit(std::string_view expected_sha256) {
  POISE_ASSIGN_OR_RETURN(const auto lock, LockUpload());
  const std::string digest = digest_.HexDigest();
  if (!expected_sha256.empty() && expected_sha256 != digest) {
    if (claim_) unlink(staging_.c_str());
    return base::InvalidArgument("WRONG_DIGEST", "sha256",
                                 fmt::format("{} bytes arrived with SHA-256 {}, expected {}", size_,
                                             digest, expected_sha256.substr(0, digest.size())));
  }
  base::FailPoint("artifacts.before_commit");
  if (fsync(file_) != 0) return CannotStore(staging_);
  POISE_RETURN_IF_ERROR(MoveTo(digest));
  base::FailPoint("artifacts.after_commit");
  return ArtifactInfo{ArtifactName(digest), size_};
}

Status ArtifactWriter::MoveTo(const std::string& digest) {
  const fs::path folder = place_.root / digest.substr(0, 2);
  std::error_code error;
  const bool made = fs::create_directory(folder, error);
  if (error) {
    errno = error.value();
    return CannotStore(folder);
  }
  {
    // Renaming onto a file of the same content changes nothing that a reader could see.
    std::lock_guard lock(*place_.names);
    if (rename(staging_.c_str(), (folder / digest).c_str()) != 0) return CannotStore(folder);
  }
  staging_.clear();
  POISE_RETURN_IF_ERROR(SyncFolder(folder));
  return made ? SyncFolder(place_.root) : absl::OkStatus();
}

}  // namespace poise::artifacts
