#ifndef POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_
#define POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/artifacts/artifact_writer.h"
#include "core/base/status.h"

namespace poise::artifacts {

struct ArtifactStoreConfig {
  std::filesystem::path root;                  ///< folder of the files; made when absent
  int64_t max_artifact_bytes = 4'000'000'000;  ///< [bytes, > 0] a larger file is refused
};

/// Immutable files named by the SHA-256 of their content, below one folder:
/// <root>/<first two digits>/<digest>, and <root>/staging/ for files on their way.
/// A file appears complete or not at all, whatever dies when: it is written under a staging name,
/// synced, renamed, and its folder synced. Storing the same bytes twice keeps one file.
/// Threads: all members may be called from any thread.
class ArtifactStore {
 public:
  /// Removes what an earlier process left in staging: one process owns the folder.
  /// Errors: kFailedPrecondition BAD_DATA_DIR.
  static StatusOr<std::unique_ptr<ArtifactStore>> Create(ArtifactStoreConfig config);

  /// A file to be written piece by piece. Errors: those of ArtifactWriter::Create.
  StatusOr<std::unique_ptr<ArtifactWriter>> NewWriter();

  /// Stores a file that is in memory. Errors: those of ArtifactWriter.
  StatusOr<ArtifactInfo> Put(std::string_view bytes);

  /// Errors, here and below: kInvalidArgument BAD_ARTIFACT_NAME, kNotFound ARTIFACT_NOT_FOUND.
  StatusOr<ArtifactInfo> Get(std::string_view name) const;

  /// At most `max_bytes` bytes from `offset`; fewer, or none, at the end.
  /// Errors: kInvalidArgument BAD_OFFSET (negative or behind the end); kDataLoss CANNOT_READ.
  StatusOr<std::string> Read(std::string_view name, int64_t offset, int64_t max_bytes) const;

  /// The whole file, checked against its name.
  /// Errors: kInvalidArgument TOO_LARGE (more than `max_bytes`); kDataLoss CANNOT_READ,
  /// CORRUPT_ARTIFACT.
  StatusOr<std::string> ReadAll(std::string_view name, int64_t max_bytes) const;

 private:
  explicit ArtifactStore(ArtifactStoreConfig config) : config_(std::move(config)) {}

  ArtifactStoreConfig config_;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_
