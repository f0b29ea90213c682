#include "core/runtime/serving/predictor_catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/config_fields.h"
#include "core/prediction/predictor_registry.h"

namespace poise::serving {
namespace {

constexpr char kBuiltInVersion[] = "1";

Status AtModel(const Status& status) {
  return base::MakeError(status.code(), base::ErrorReason(status), "model", base::Message(status));
}

// The first forward pass is the slowest, and shows whether there is one: of a body at rest.
Status WarmUp(const prediction::Predictor& predictor) {
  const prediction::PredictorSignature& signature = predictor.signature();
  if (signature.skeleton == nullptr) return absl::OkStatus();
  const auto frames = static_cast<size_t>(signature.past_frames);
  POISE_ASSIGN_OR_RETURN(
      motion::Clip rest,
      motion::Clip::Create("warm-up", signature.skeleton, signature.frame_rate,
                           std::vector<motion::Vec3>(frames, motion::Vec3::Zero()),
                           std::vector<motion::Quat>(frames * signature.skeleton->num_joints(),
                                                     motion::Quat::Identity())));
  const prediction::Observation seen{std::move(rest)};
  return predictor.Predict({&seen, 1}, 1, {}).status();
}

}  // namespace

Status PredictorCatalog::UnknownModel(const std::string& name) const {
  std::vector<std::string> names = prediction::BuiltInPredictorNames();
  for (const api::Model& model : models_.List()) names.push_back(model.name);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const std::string nearest = base::NearestName(name, names);
  return base::NotFound(
      "UNKNOWN_MODEL", "model",
      fmt::format("no model '{}'; there are: {}{}", name, fmt::join(names, ", "),
                  nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

StatusOr<ServedPredictor> PredictorCatalog::Find(std::string_view model) {
  const StatusOr<api::ModelReference> reference = api::ModelReference::Parse(model);
  if (!reference.ok()) return AtModel(reference.status());
  std::shared_ptr<const prediction::Predictor> floor =
      prediction::FindBuiltInPredictor(reference->name);
  if (floor == nullptr) return FindTrained(*reference);
  if (reference->version.empty() || reference->version == kBuiltInVersion) {
    return ServedPredictor{reference->name, kBuiltInVersion, std::move(floor)};
  }
  return base::NotFound("UNKNOWN_VERSION", "model",
                        fmt::format("model '{}' has no version '{}', only '{}'", reference->name,
                                    reference->version, kBuiltInVersion));
}

StatusOr<ServedPredictor> PredictorCatalog::FindTrained(const api::ModelReference& reference) {
  const StatusOr<api::Model> found = models_.Get(reference);
  if (!found.ok()) {
    const bool known = models_.Get({.name = reference.name, .version = ""}).ok();
    if (found.status().code() != absl::StatusCode::kNotFound) return AtModel(found.status());
    if (!known) return UnknownModel(reference.name);
    return base::NotFound("UNKNOWN_VERSION", "model", base::Message(found.status()));
  }
  std::lock_guard lock(mutex_);
  for (auto entry = loaded_.begin(); entry != loaded_.end(); ++entry) {
    if (entry->name != found->name || entry->version != found->version) continue;
    loaded_.splice(loaded_.begin(), loaded_, entry);
    return loaded_.front();
  }
  const auto artifact = models_.Load({.name = found->name, .version = found->version});
  if (!artifact.ok()) return AtModel(artifact.status());
  const auto predictor = prediction::MakeTrainedPredictor(*artifact);
  if (!predictor.ok()) return AtModel(predictor.status());
  if (const Status status = WarmUp(**predictor); !status.ok()) return AtModel(status);
  loaded_.push_front({found->name, found->version, *predictor});
  if (loaded_.size() > kMaxLoaded) loaded_.pop_back();
  return loaded_.front();
}

}  // namespace poise::serving
