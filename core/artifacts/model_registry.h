#ifndef POISE_CORE_ARTIFACTS_MODEL_REGISTRY_H_
#define POISE_CORE_ARTIFACTS_MODEL_REGISTRY_H_

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/api/model_card.h"
#include "core/artifacts/model_artifact.h"
#include "core/base/status.h"

namespace poise::artifacts {

struct ModelRegistryConfig {
  std::filesystem::path root;     ///< made when absent; one server owns it
  std::filesystem::path shipped;  ///< models that came with the program, read only; may be absent
};

/// Models by name and version: folders ROOT/<name>/<version>/ (model_artifact.h). A version never
/// changes once it is there. What the bare name means is the version that was set, else the newest.
/// Threads: all members may be called from any thread.
class ModelRegistry {
 public:
  /// Removes what an earlier process left half-done. Errors: kFailedPrecondition BAD_DATA_DIR.
  static StatusOr<std::unique_ptr<ModelRegistry>> Open(ModelRegistryConfig config);

  /// Sorted by name, then version. A folder that cannot be read is left out, and named in `broken`
  /// where that is wanted.
  std::vector<api::Model> List(std::vector<std::string>* broken = nullptr) const;

  /// Errors: kNotFound MODEL_NOT_FOUND with the names or versions there are.
  StatusOr<api::Model> Get(const api::ModelReference& reference) const;
  /// The version that is meant, without reading its card. Errors: as Get.
  StatusOr<api::ModelReference> Resolve(const api::ModelReference& reference) const;
  /// Changes whenever a reference may have come to mean something else.
  int64_t generation() const { return generation_.load(std::memory_order_acquire); }
  /// With the weights. Errors: as Get; kDataLoss CORRUPT_MODEL.
  StatusOr<ModelArtifact> Load(const api::ModelReference& reference) const;

  /// Adds it as the next version of `name`; a model with the same card and weights that is there
  /// already is answered as it is. Errors: kInvalidArgument BAD_MODEL_NAME; kUnavailable
  /// CANNOT_STORE.
  StatusOr<api::Model> Import(const std::string& name, const ModelArtifact& model);

  /// Errors: those of Get; kInvalidArgument MISSING_VERSION (none given).
  StatusOr<api::Model> SetDefault(const api::ModelReference& reference);
  /// Who has loaded it keeps it. Errors: those of SetDefault; kFailedPrecondition SHIPPED_MODEL.
  Status Delete(const api::ModelReference& reference);

 private:
  explicit ModelRegistry(ModelRegistryConfig config) : config_(std::move(config)) {}

  struct Place {
    std::string version;
    std::filesystem::path folder;
    bool shipped = false;
  };

  std::vector<std::string> Names() const;
  std::vector<Place> Versions(const std::string& name) const;  // oldest first
  std::string DefaultVersion(const std::string& name, const std::vector<Place>& places) const;
  StatusOr<Place> Find(const api::ModelReference& reference) const;
  StatusOr<Place> FindExact(const api::ModelReference& reference) const;
  StatusOr<api::Model> Describe(const std::string& name, const Place& place) const;

  const ModelRegistryConfig config_;
  mutable std::mutex mutex_;
  std::atomic<int64_t> generation_ = 0;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_MODEL_REGISTRY_H_
