#include "core/engine/model_catalog.h"

#include <fmt/format.h>

#include <utility>

#include "core/engine/flow_table.h"

namespace poise::engine {
namespace {

constexpr int64_t kMaxModelBytes = int64_t{4} << 30;

Status AtArtifact(const Status& status) {
  return base::MakeError(status.code(), base::ErrorReason(status), "artifact",
                         base::Message(status));
}

}  // namespace

StatusOr<api::Model> ModelCatalog::Get(std::string_view model) const {
  POISE_ASSIGN_OR_RETURN(const auto reference, api::ModelReference::Parse(model));
  return registry_.Get(reference);
}

StatusOr<artifacts::ModelArtifact> ModelCatalog::Load(std::string_view model) const {
  POISE_ASSIGN_OR_RETURN(const auto reference, api::ModelReference::Parse(model));
  return registry_.Load(reference);
}

StatusOr<api::Model> ModelCatalog::SetDefault(std::string_view model) {
  POISE_ASSIGN_OR_RETURN(const auto reference, api::ModelReference::Parse(model));
  return registry_.SetDefault(reference);
}

Status ModelCatalog::Delete(std::string_view model) {
  POISE_ASSIGN_OR_RETURN(const auto reference, api::ModelReference::Parse(model));
  return registry_.Delete(reference);
}

StatusOr<api::Model> ModelCatalog::Import(const std::string& name, const std::string& artifact) {
  const StatusOr<std::string> bytes = artifacts_.ReadAll(artifact, kMaxModelBytes);
  if (!bytes.ok()) return AtArtifact(bytes.status());
  const StatusOr<artifacts::ModelArtifact> model = artifacts::UnpackModel(*bytes, artifact);
  if (!model.ok()) return AtArtifact(model.status());
  return registry_.Import(name, *model);
}

Status ModelCatalog::ImportTrained(const api::Job& job,
                                   const std::vector<api::JobArtifact>& artifacts) {
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(job.spec.kind));
  const std::string name = flow->trains ? job.spec.parameters.value("name", "") : "";
  if (name.empty()) return absl::OkStatus();
  for (const api::JobArtifact& artifact : artifacts) {
    if (artifact.name == kModelFile) return Import(name, artifact.artifact).status();
  }
  return base::MakeError(
      absl::StatusCode::kInternal, "NO_MODEL_FILE", "artifacts",
      fmt::format("a job of kind '{}' ended without {}", flow->kind, kModelFile));
}

StatusOr<artifacts::ArtifactInfo> ModelCatalog::Export(std::string_view model) {
  POISE_ASSIGN_OR_RETURN(artifacts::ModelArtifact artifact, Load(model));
  return artifacts_.Put(artifacts::PackModel(std::move(artifact)));
}

}  // namespace poise::engine
