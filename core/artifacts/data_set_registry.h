#ifndef POISE_CORE_ARTIFACTS_DATA_SET_REGISTRY_H_
#define POISE_CORE_ARTIFACTS_DATA_SET_REGISTRY_H_

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/api/data_set.h"
#include "core/artifacts/artifact_store.h"
#include "core/base/status.h"

namespace poise::artifacts {

/// Named data sets: a record each, in ROOT/<name>.json; the clips are artifacts, which whoever
/// collects artifacts must keep (Artifacts()).
/// Threads: all members may be called from any thread.
class DataSetRegistry {
 public:
  /// `store` outlives the registry. Errors: kFailedPrecondition BAD_DATA_DIR.
  static StatusOr<std::unique_ptr<DataSetRegistry>> Open(const std::filesystem::path& root,
                                                         ArtifactStore& store);

  /// Reads and checks the clips in `artifact` and gives them a name. The same clips again under the
  /// same name are no error. Errors: kInvalidArgument BAD_DATA_SET_NAME; kAlreadyExists
  /// DATA_SET_EXISTS with other clips; those of ArtifactStore::ReadAll and DecodeClipSet with field
  /// "artifact"; kUnavailable CANNOT_STORE.
  StatusOr<api::DataSet> Create(const std::string& name, const std::string& artifact);

  /// Errors: kNotFound DATA_SET_NOT_FOUND with the names there are.
  StatusOr<api::DataSet> Get(const std::string& name) const;
  /// By name.
  std::vector<api::DataSet> List() const;
  /// Models that learned from it keep its fingerprint. Errors: as Get.
  Status Delete(const std::string& name);

  /// Of all data sets.
  std::vector<std::string> Artifacts() const;

 private:
  DataSetRegistry(std::filesystem::path root, ArtifactStore& store)
      : root_(std::move(root)), store_(store) {}

  std::filesystem::path RecordPath(const std::string& name) const {
    return root_ / (name + ".json");
  }
  StatusOr<api::DataSet> GetLocked(const std::string& name) const;
  std::vector<api::DataSet> ListLocked() const;

  const std::filesystem::path root_;
  ArtifactStore& store_;
  mutable std::mutex mutex_;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_DATA_SET_REGISTRY_H_
