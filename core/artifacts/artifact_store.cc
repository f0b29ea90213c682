#include "core/artifacts/artifact_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "absl/time/clock.h"
#include "core/artifacts/artifact_name.h"
#include "core/base/fail_point.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

constexpr absl::Duration kCollectionInterval = absl::Hours(1);

// An open artifact and its size.
class File {
 public:
  static StatusOr<File> Open(const fs::path& root, std::string_view name) {
    POISE_ASSIGN_OR_RETURN(const std::string digest, DigestOf(name));
    const fs::path path = root / digest.substr(0, 2) / digest;
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (descriptor < 0 || fstat(descriptor, &info) != 0) {
      if (descriptor >= 0) close(descriptor);
      return base::NotFound("ARTIFACT_NOT_FOUND", "name",
                            fmt::format("there is no {} on this server", name));
    }
    return File(descriptor, info.st_size);
  }
  File(File&& other) : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }

  int64_t size() const { return size_; }

  StatusOr<std::string> Read(int64_t offset, int64_t max_bytes) const {
    std::string bytes(std::clamp<int64_t>(size_ - offset, 0, max_bytes), '\0');
    size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t got =
          pread(descriptor_, bytes.data() + done, bytes.size() - done, offset + done);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        return base::MakeError(absl::StatusCode::kDataLoss, "CANNOT_READ", "name",
                               fmt::format("cannot read the artifact at byte {}: {}", offset + done,
                                           got < 0 ? std::strerror(errno) : "it ends early"));
      }
      done += got;
    }
    return bytes;
  }

 private:
  File(int descriptor, int64_t size) : descriptor_(descriptor), size_(size) {}

  int descriptor_;
  int64_t size_;
};

}  // namespace

StatusOr<std::unique_ptr<ArtifactStore>> ArtifactStore::Create(ArtifactStoreConfig config) {
  const fs::path staging = config.root / "staging";
  std::error_code error;
  fs::remove_all(staging, error);
  if (!error) fs::create_directories(staging, error);
  if (!error) fs::create_directories(config.root / "uploads", error);
  if (error || access(staging.c_str(), W_OK) != 0) {
    return base::FailedPrecondition("BAD_DATA_DIR", "data_dir",
                                    fmt::format("cannot write below '{}': {}", config.root.string(),
                                                error ? error.message() : std::strerror(errno)));
  }
  std::unique_ptr<ArtifactStore> store(new ArtifactStore(std::move(config)));
  store->CollectUploads(absl::Now());
  return store;
}

StatusOr<std::unique_ptr<ArtifactWriter>> ArtifactStore::NewWriter() {
  return ArtifactWriter::Create(NewPlace());
}

StatusOr<std::unique_ptr<ArtifactWriter>> ArtifactStore::ResumeWriter(const std::string& upload_id,
                                                                      int64_t offset) {
  POISE_RETURN_IF_ERROR(CheckUploadId(upload_id));
  bool collect = false;
  {
    std::lock_guard lock(collection_mutex_);
    collect = absl::Now() - last_collection_ > kCollectionInterval;
  }
  if (collect) CollectUploads(absl::Now());
  return ArtifactWriter::Resume(NewPlace(), config_.root / "uploads" / upload_id,
                                uploads_.Claim(upload_id), offset);
}

StatusOr<int64_t> ArtifactStore::ReceivedBytes(const std::string& upload_id) const {
  POISE_RETURN_IF_ERROR(CheckUploadId(upload_id));
  struct stat info {};
  const fs::path file = config_.root / "uploads" / upload_id;
  return stat(file.c_str(), &info) == 0 ? info.st_size : 0;
}

StatusOr<ArtifactInfo> ArtifactStore::Put(std::string_view bytes) {
  POISE_ASSIGN_OR_RETURN(const std::unique_ptr<ArtifactWriter> writer, NewWriter());
  POISE_RETURN_IF_ERROR(writer->Append(bytes));
  return writer->Commit();
}

StatusOr<ArtifactInfo> ArtifactStore::Get(std::string_view name) const {
  POISE_ASSIGN_OR_RETURN(const File file, File::Open(config_.root, name));
  return ArtifactInfo{std::string(name), file.size()};
}

StatusOr<ArtifactInfo> ArtifactStore::Refresh(std::string_view name) {
  std::lock_guard lock(names_);
  POISE_ASSIGN_OR_RETURN(ArtifactInfo info, Get(name));
  POISE_ASSIGN_OR_RETURN(const std::string digest, DigestOf(name));
  const fs::path path = config_.root / digest.substr(0, 2) / digest;
  if (utimensat(AT_FDCWD, path.c_str(), nullptr, 0) != 0) {
    return base::MakeError(absl::StatusCode::kUnavailable, "CANNOT_STORE", "name",
                           fmt::format("cannot touch {}: {}", name, std::strerror(errno)));
  }
  return info;
}

StatusOr<std::string> ArtifactStore::Read(std::string_view name, int64_t offset,
                                          int64_t max_bytes) const {
  base::FailPoint("artifacts.before_read");
  POISE_ASSIGN_OR_RETURN(const File file, File::Open(config_.root, name));
  if (offset < 0 || offset > file.size()) {
    return base::InvalidArgument(
        "BAD_OFFSET", "offset",
        fmt::format("offset is {}, expected 0 to the file's size {}", offset, file.size()));
  }
  return file.Read(offset, max_bytes);
}

StatusOr<std::string> ArtifactStore::ReadAll(std::string_view name, int64_t max_bytes) const {
  POISE_ASSIGN_OR_RETURN(const File file, File::Open(config_.root, name));
  if (file.size() > max_bytes) {
    return base::InvalidArgument(
        "TOO_LARGE", "name",
        fmt::format("the artifact has {} bytes, at most {} expected", file.size(), max_bytes));
  }
  POISE_ASSIGN_OR_RETURN(std::string bytes, file.Read(0, file.size()));
  base::Sha256 digest;
  digest.Update(bytes);
  if (ArtifactName(digest.HexDigest()) != name) {
    return base::MakeError(absl::StatusCode::kDataLoss, "CORRUPT_ARTIFACT", "name",
                           fmt::format("the content of {} is not what was stored", name));
  }
  return bytes;
}

}  // namespace poise::artifacts
