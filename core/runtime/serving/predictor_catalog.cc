#include "core/runtime/serving/predictor_catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/config_fields.h"
#include "core/prediction/predictor_registry.h"
#include "core/runtime/serving/batching_predictor.h"

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
  {
    std::lock_guard lock(mutex_);
    const auto known = meanings_.find(model);
    if (known != meanings_.end() && generation_ == models_.generation()) {
      return Touch(known->second);
    }
  }
  const StatusOr<api::ModelReference> reference = api::ModelReference::Parse(model);
  if (!reference.ok()) return AtModel(reference.status());
  std::shared_ptr<const prediction::Predictor> floor =
      prediction::FindBuiltInPredictor(reference->name);
  if (floor == nullptr) return FindTrained(model, *reference);
  if (reference->version.empty() || reference->version == kBuiltInVersion) {
    return ServedPredictor{reference->name, kBuiltInVersion, std::move(floor)};
  }
  return base::NotFound("UNKNOWN_VERSION", "model",
                        fmt::format("model '{}' has no version '{}', only '{}'", reference->name,
                                    reference->version, kBuiltInVersion));
}

StatusOr<ServedPredictor> PredictorCatalog::FindTrained(std::string_view model,
                                                        const api::ModelReference& reference) {
  const int64_t generation = models_.generation();
  POISE_ASSIGN_OR_RETURN(const api::ModelReference version, Resolve(reference));
  const std::string full_name = version.ToString();
  std::unique_lock lock(mutex_);
  while (true) {
    if (const auto entry = FindLoaded(version.name, version.version); entry != loaded_.end()) {
      Remember(model, generation, entry);
      return Touch(entry);
    }
    if (!loading_.contains(full_name)) break;
    if (reference.version.empty()) {
      const auto older = FindLoaded(version.name, "");
      if (older != loaded_.end()) return Touch(older);
    }
    load_ended_.wait(lock);
  }
  loading_.insert(full_name);
  lock.unlock();
  StatusOr<ServedPredictor> loaded = Load(version);
  lock.lock();
  loading_.erase(full_name);
  load_ended_.notify_all();
  if (!loaded.ok()) return AtModel(loaded.status());
  loaded_.push_front(*loaded);
  Remember(model, generation, loaded_.begin());
  if (loaded_.size() > kMaxLoaded) {
    loaded_.pop_back();
    meanings_.clear();
  }
  return loaded;
}

StatusOr<api::ModelReference> PredictorCatalog::Resolve(
    const api::ModelReference& reference) const {
  StatusOr<api::ModelReference> found = models_.Resolve(reference);
  if (found.ok()) return found;
  if (found.status().code() != absl::StatusCode::kNotFound) return AtModel(found.status());
  const bool known = models_.Resolve({.name = reference.name, .version = ""}).ok();
  if (!known) return UnknownModel(reference.name);
  return base::NotFound("UNKNOWN_VERSION", "model", base::Message(found.status()));
}

StatusOr<ServedPredictor> PredictorCatalog::Load(const api::ModelReference& version) const {
  POISE_ASSIGN_OR_RETURN(const auto artifact, models_.Load(version));
  POISE_ASSIGN_OR_RETURN(auto predictor, prediction::MakeTrainedPredictor(artifact));
  POISE_RETURN_IF_ERROR(WarmUp(*predictor));
  const base::Labels labels = {{"model", version.ToString()}};
  return ServedPredictor{
      version.name, version.version,
      std::make_shared<BatchingPredictor>(std::move(predictor), config_, telemetry_, labels),
      std::make_shared<LoadGate>(config_, telemetry_, labels)};
}

PredictorCatalog::Loaded::iterator PredictorCatalog::FindLoaded(const std::string& name,
                                                                const std::string& version) {
  return std::find_if(loaded_.begin(), loaded_.end(), [&](const ServedPredictor& entry) {
    return entry.name == name && (version.empty() || entry.version == version);
  });
}

const ServedPredictor& PredictorCatalog::Touch(Loaded::iterator entry) {
  loaded_.splice(loaded_.begin(), loaded_, entry);
  return *entry;
}

void PredictorCatalog::Remember(std::string_view model, int64_t generation,
                                Loaded::iterator entry) {
  if (generation != models_.generation()) return;
  if (generation_ != generation) meanings_.clear();
  generation_ = generation;
  meanings_.insert_or_assign(std::string(model), entry);
}

}  // namespace poise::serving
