#ifndef POISE_CORE_ENGINE_MODEL_CATALOG_H_
#define POISE_CORE_ENGINE_MODEL_CATALOG_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/api/job.h"
#include "core/artifacts/artifact_store.h"
#include "core/artifacts/model_registry.h"
#include "core/base/status.h"

namespace poise::engine {

/// The models of this server as callers refer to them ("NAME" or "NAME@VERSION"), and their way in
/// and out as artifacts.
/// Threads: all members may be called from any thread.
class ModelCatalog {
 public:
  /// Both outlive the catalog.
  ModelCatalog(artifacts::ModelRegistry& registry, artifacts::ArtifactStore& artifacts)
      : registry_(registry), artifacts_(artifacts) {}

  /// Errors, of all: kInvalidArgument BAD_MODEL_NAME; those of ModelRegistry.
  std::vector<api::Model> List() const { return registry_.List(); }
  StatusOr<api::Model> Get(std::string_view model) const;
  StatusOr<artifacts::ModelArtifact> Load(std::string_view model) const;
  StatusOr<api::Model> SetDefault(std::string_view model);
  Status Delete(std::string_view model);

  /// Errors: those of UnpackModel and ArtifactStore::ReadAll with the field "artifact".
  StatusOr<api::Model> Import(const std::string& name, const std::string& artifact);
  /// Gives what a finished job learned the name that its parameters ask for (Flow::trains); the
  /// same job again changes nothing. Errors: those of Import; kInternal NO_MODEL_FILE.
  Status ImportTrained(const api::Job& job, const std::vector<api::JobArtifact>& artifacts);
  /// As one file, to be downloaded within the retention of artifacts.
  StatusOr<artifacts::ArtifactInfo> Export(std::string_view model);

 private:
  artifacts::ModelRegistry& registry_;
  artifacts::ArtifactStore& artifacts_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_MODEL_CATALOG_H_
