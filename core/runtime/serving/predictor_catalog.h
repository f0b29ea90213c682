#ifndef POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
#define POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/api/model_card.h"
#include "core/artifacts/model_registry.h"
#include "core/base/status.h"
#include "core/prediction/predictor.h"

namespace poise::serving {

/// A predictor as requests name it.
struct ServedPredictor {
  std::string name;
  std::string version;
  std::shared_ptr<const prediction::Predictor> predictor;
};

/// Which predictor stands behind a name: the floors that need no training, and the trained models
/// of the registry. A trained model is rebuilt and run once when it is first asked for, and kept;
/// who uses one that goes keeps it.
/// Threads: all members may be called from any thread; one model is loaded at a time.
class PredictorCatalog {
 public:
  /// `models` outlives the catalog.
  explicit PredictorCatalog(const artifacts::ModelRegistry& models) : models_(models) {}

  /// `model` is "NAME" (its default version) or "NAME@VERSION"; a floor's name means the floor.
  /// Errors: kInvalidArgument BAD_MODEL_NAME; kNotFound UNKNOWN_MODEL with the names there are,
  /// UNKNOWN_VERSION; those of ModelRegistry::Load and MakeTrainedPredictor; all with the field
  /// "model".
  StatusOr<ServedPredictor> Find(std::string_view model);

 private:
  static constexpr size_t kMaxLoaded = 16;

  StatusOr<ServedPredictor> FindTrained(const api::ModelReference& reference);
  Status UnknownModel(const std::string& name) const;

  const artifacts::ModelRegistry& models_;
  std::mutex mutex_;
  std::list<ServedPredictor> loaded_;  // the latest used first
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
