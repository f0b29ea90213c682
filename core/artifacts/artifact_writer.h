#ifndef POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_
#define POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/artifacts/upload_table.h"
#include "core/base/sha256.h"
#include "core/base/status.h"

namespace poise::artifacts {

struct ArtifactInfo {
  std::string name;  ///< "artifacts/<sha256>"
  int64_t size_bytes = 0;
};

/// One artifact on its way into a store; made by ArtifactStore::NewWriter or ResumeWriter.
/// Destroying it without Commit leaves nothing behind, or, of an upload with an id, what was
/// written so far. Threads: one caller at a time.
class ArtifactWriter {
 public:
  /// Where files of one store are written.
  struct Place {
    std::filesystem::path root;  ///< the store's folder
    int64_t max_bytes;
    std::mutex* names;  ///< held while an artifact appears, or goes
  };

  /// A file of its own. Errors: kUnavailable CANNOT_STORE.
  static StatusOr<std::unique_ptr<ArtifactWriter>> Create(const Place& place);

  /// Goes on with the upload in `file` behind its first `offset` bytes, which are read again for
  /// the digest; what is behind them is cut off.
  /// Errors, of the members too: kAborted UPLOAD_TAKEN_OVER. kFailedPrecondition WRONG_OFFSET when
  /// it has fewer bytes; kUnavailable CANNOT_STORE.
  static StatusOr<std::unique_ptr<ArtifactWriter>> Resume(const Place& place,
                                                          const std::filesystem::path& file,
                                                          UploadClaim claim, int64_t offset);

  ~ArtifactWriter();
  ArtifactWriter(const ArtifactWriter&) = delete;
  ArtifactWriter& operator=(const ArtifactWriter&) = delete;

  /// Errors: kInvalidArgument TOO_LARGE; kResourceExhausted DISK_FULL; kUnavailable CANNOT_STORE.
  Status Append(std::string_view bytes);

  /// Makes the file durable and visible. `expected_sha256` may be empty; otherwise it must fit.
  /// Errors: kInvalidArgument WRONG_DIGEST, after which nothing is left of an upload with an id
  /// either; those of Append.
  StatusOr<ArtifactInfo> Commit(std::string_view expected_sha256 = "");

 private:
  ArtifactWriter(Place place, std::filesystem::path staging, int file,
                 std::optional<UploadClaim> claim)
      : place_(std::move(place)),
        staging_(std::move(staging)),
        file_(file),
        claim_(std::move(claim)) {}

  // Keeps later claims on the same upload waiting; empty without an id.
  StatusOr<std::unique_lock<std::mutex>> LockUpload() const;
  Status ReadPrefix(int64_t offset);
  Status MoveTo(const std::string& digest);

  const Place place_;
  std::filesystem::path staging_;  // empty once it has its name
  const int file_;
  const std::optional<UploadClaim> claim_;
  int64_t size_ = 0;
  base::Sha256 digest_;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_ARTIFACT_WRITER_H_
