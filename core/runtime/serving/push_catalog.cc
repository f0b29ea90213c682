#include "core/runtime/serving/push_catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace poise::serving {
namespace {

Status AtModel(const Status& status) {
  return base::MakeError(status.code(), base::ErrorReason(status), "model", base::Message(status));
}

}  // namespace

Status PushCatalog::UnknownModel(const std::string& name) const {
  std::vector<std::string> names = {kStatue};
  for (const api::Model& model : models_.List()) {
    if (model.card.family == push::kModelFamily) names.push_back(model.name);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return base::NotFound(
      "UNKNOWN_MODEL", "model",
      fmt::format("no push model '{}'; there are: {}", name, fmt::join(names, ", ")));
}

StatusOr<ServedForecaster> PushCatalog::Find(std::string_view model,
                                             const base::Overrides& overrides) {
  if (model.empty()) {
    const bool there = models_.Get({.name = kDefaultModel, .version = ""}).ok();
    model = there ? kDefaultModel : kStatue;
  }
  if (model == kStatue) {
    POISE_ASSIGN_OR_RETURN(auto statue, push::MakeStatueForecaster(overrides));
    return ServedForecaster{kStatue, std::move(statue)};
  }
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, {}));
  const StatusOr<api::ModelReference> reference = api::ModelReference::Parse(model);
  if (!reference.ok()) return AtModel(reference.status());
  return FindTrained(*reference);
}

StatusOr<ServedForecaster> PushCatalog::FindTrained(const api::ModelReference& reference) {
  const StatusOr<api::Model> found = models_.Get(reference);
  if (absl::IsNotFound(found.status())) return UnknownModel(reference.ToString());
  if (!found.ok()) return AtModel(found.status());
  const api::ModelReference version{.name = found->name, .version = found->version};
  std::lock_guard lock(mutex_);
  for (auto entry = loaded_.begin(); entry != loaded_.end(); ++entry) {
    if (entry->model != version.ToString()) continue;
    loaded_.splice(loaded_.begin(), loaded_, entry);
    return loaded_.front();
  }
  const auto artifact = models_.Load(version);
  if (!artifact.ok()) return AtModel(artifact.status());
  auto forecaster = push::MakeLearnedForecaster(*artifact);
  if (!forecaster.ok()) return AtModel(forecaster.status());
  loaded_.push_front({version.ToString(), *std::move(forecaster)});
  if (loaded_.size() > kMaxLoaded) loaded_.pop_back();
  return loaded_.front();
}

}  // namespace poise::serving
