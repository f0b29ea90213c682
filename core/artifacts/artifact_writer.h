#ifndef POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_
#define POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/sha256.h"
#include "core/base/status.h"

namespace poise::artifacts {

struct ArtifactInfo {
  std::string name;  ///< "artifacts/<sha256>"
  int64_t size_bytes = 0;
};

/// One artifact on its way into a store; made by ArtifactStore::NewWriter. Destroying it without
/// Commit leaves nothing behind.
/// Threads: one caller at a time.
class ArtifactWriter {
 public:
  /// `root` is the store's folder. Errors: kUnavailable CANNOT_STORE.
  static StatusOr<std::unique_ptr<ArtifactWriter>> Create(const std::filesystem::path& root,
                                                          int64_t max_bytes);
  ~ArtifactWriter();
  ArtifactWriter(const ArtifactWriter&) = delete;
  ArtifactWriter& operator=(const ArtifactWriter&) = delete;

  /// Errors: kInvalidArgument TOO_LARGE; kResourceExhausted DISK_FULL; kUnavailable CANNOT_STORE.
  Status Append(std::string_view bytes);

  /// Makes the file durable and visible. `expected_sha256` may be empty; otherwise it must fit.
  /// Errors: kInvalidArgument WRONG_DIGEST; those of Append.
  StatusOr<ArtifactInfo> Commit(std::string_view expected_sha256 = "");

 private:
  ArtifactWriter(std::filesystem::path root, std::filesystem::path staging, int file,
                 int64_t max_bytes)
      : root_(std::move(root)), staging_(std::move(staging)), file_(file), max_bytes_(max_bytes) {}

  std::filesystem::path root_;
  std::filesystem::path staging_;
  int file_;
  int64_t max_bytes_;
  int64_t size_ = 0;
  base::Sha256 digest_;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_
