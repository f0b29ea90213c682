#ifndef POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
#define POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "core/api/model_card.h"
#include "core/artifacts/model_registry.h"
#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "core/prediction/predictor.h"
#include "core/runtime/serving/load_gate.h"

namespace poise::serving {

/// A predictor as requests name it.
struct ServedPredictor {
  std::string name;
  std::string version;
  std::shared_ptr<const prediction::Predictor> predictor;  ///< a trained one makes batches
  std::shared_ptr<LoadGate> gate = nullptr;                ///< of a trained one
};

/// Which predictor stands behind a name: the floors that need no training, and the trained models
/// of the registry. A trained model is rebuilt and run once when it is first asked for, and kept;
/// who uses one that goes keeps it. While a newer version is being loaded, requests that name no
/// version get the one that was there.
/// Threads: all members may be called from any thread.
class PredictorCatalog {
 public:
  /// `models` and `telemetry` outlive the catalog.
  PredictorCatalog(const artifacts::ModelRegistry& models, const ServingConfig& config,
                   base::Telemetry& telemetry)
      : models_(models), config_(config), telemetry_(telemetry) {}

  /// `model` is "NAME" (its default version) or "NAME@VERSION"; a floor's name means the floor.
  /// Errors: kInvalidArgument BAD_MODEL_NAME; kNotFound UNKNOWN_MODEL with the names there are,
  /// UNKNOWN_VERSION; those of ModelRegistry::Load and MakeTrainedPredictor; all with the field
  /// "model".
  StatusOr<ServedPredictor> Find(std::string_view model);

 private:
  static constexpr size_t kMaxLoaded = 16;
  using Loaded = std::list<ServedPredictor>;

  StatusOr<ServedPredictor> FindTrained(std::string_view model,
                                        const api::ModelReference& reference);
  StatusOr<api::ModelReference> Resolve(const api::ModelReference& reference) const;
  StatusOr<ServedPredictor> Load(const api::ModelReference& version) const;
  Status UnknownModel(const std::string& name) const;
  // With mutex_ held. Any version where `version` is empty.
  Loaded::iterator FindLoaded(const std::string& name, const std::string& version);
  const ServedPredictor& Touch(Loaded::iterator entry);
  void Remember(std::string_view model, int64_t generation, Loaded::iterator entry);

  const artifacts::ModelRegistry& models_;
  const ServingConfig config_;
  base::Telemetry& telemetry_;

  std::mutex mutex_;
  std::condition_variable load_ended_;
  std::set<std::string> loading_;  // "NAME@VERSION"
  Loaded loaded_;                  // the latest used first
  // What references meant at a generation of the registry: it reads folders to tell.
  std::map<std::string, Loaded::iterator, std::less<>> meanings_;
  int64_t generation_ = -1;
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
