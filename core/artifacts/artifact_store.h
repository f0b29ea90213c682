#ifndef POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_
#define POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "absl/time/time.h"
#include "core/artifacts/artifact_writer.h"
#include "core/artifacts/upload_table.h"
#include "core/base/status.h"

namespace poise::artifacts {

struct ArtifactStoreConfig {
  std::filesystem::path root;                         ///< folder of the files; made when absent
  int64_t max_artifact_bytes = 4'000'000'000;         ///< [bytes, > 0] a larger file is refused
  absl::Duration upload_retention = absl::Hours(24);  ///< of an upload that nobody goes on with
};

/// Immutable files named by the SHA-256 of their content, below one folder:
/// <root>/<first two digits>/<digest>, <root>/staging/ for files on their way, and <root>/uploads/
/// for those of uploads with an id, which outlive the stream and the process that brings them. A
/// file appears complete or not at all, whatever dies when: it is written under a staging name,
/// synced, renamed, and its folder synced. Storing the same bytes twice keeps one file.
/// Threads: all members may be called from any thread.
class ArtifactStore {
 public:
  /// Removes what an earlier process left in staging: one process owns the folder.
  /// Errors: kFailedPrecondition BAD_DATA_DIR.
  static StatusOr<std::unique_ptr<ArtifactStore>> Create(ArtifactStoreConfig config);

  /// A file to be written piece by piece. Errors: those of ArtifactWriter::Create.
  StatusOr<std::unique_ptr<ArtifactWriter>> NewWriter();

  /// Goes on with the upload of this id behind its first `offset` bytes, and takes it over from
  /// whoever wrote to it. Errors: kInvalidArgument BAD_UPLOAD_ID; those of ArtifactWriter::Resume.
  StatusOr<std::unique_ptr<ArtifactWriter>> ResumeWriter(const std::string& upload_id,
                                                         int64_t offset);

  /// How many bytes have arrived of an upload that is not finished; 0 when none is known.
  /// Errors: kInvalidArgument BAD_UPLOAD_ID.
  StatusOr<int64_t> ReceivedBytes(const std::string& upload_id) const;

  /// Stores a file that is in memory. Errors: those of ArtifactWriter.
  StatusOr<ArtifactInfo> Put(std::string_view bytes);

  /// Errors, here and below: kInvalidArgument BAD_ARTIFACT_NAME, kNotFound ARTIFACT_NOT_FOUND.
  StatusOr<ArtifactInfo> Get(std::string_view name) const;

  /// The same, and counts as stored just now for Collect. Once it has answered, a caller may count
  /// on the artifact as if it had stored it.
  StatusOr<ArtifactInfo> Refresh(std::string_view name);

  /// At most `max_bytes` bytes from `offset`; fewer, or none, at the end.
  /// Errors: kInvalidArgument BAD_OFFSET (negative or behind the end); kDataLoss CANNOT_READ.
  StatusOr<std::string> Read(std::string_view name, int64_t offset, int64_t max_bytes) const;

  /// The whole file, checked against its name.
  /// Errors: kInvalidArgument TOO_LARGE (more than `max_bytes`); kDataLoss CANNOT_READ,
  /// CORRUPT_ARTIFACT.
  StatusOr<std::string> ReadAll(std::string_view name, int64_t max_bytes) const;

  /// Removes artifacts that are not in `keep` and were stored before `stored_before`. Returns how
  /// many.
  int64_t Collect(const std::set<std::string>& keep, absl::Time stored_before);

  /// Removes uploads to which nothing was written since the retention. Done by Create, and hourly
  /// by whoever resumes an upload; to be called daily where nobody does. Returns how many.
  int64_t CollectUploads(absl::Time now);

 private:
  explicit ArtifactStore(ArtifactStoreConfig config) : config_(std::move(config)) {}

  ArtifactWriter::Place NewPlace() {
    return {.root = config_.root, .max_bytes = config_.max_artifact_bytes, .names = &names_};
  }

  const ArtifactStoreConfig config_;
  std::mutex names_;  // held while an artifact appears, is refreshed or goes
  UploadTable uploads_;
  std::mutex collection_mutex_;
  absl::Time last_collection_ = absl::InfinitePast();
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_ARTIFACT_STORE_H_
