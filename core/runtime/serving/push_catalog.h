#ifndef POISE_CORE_RUNTIME_SERVING_PUSH_CATALOG_H_
#define POISE_CORE_RUNTIME_SERVING_PUSH_CATALOG_H_

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/artifacts/model_registry.h"
#include "core/base/config_fields.h"
#include "core/base/status.h"
#include "core/push/push_forecaster.h"

namespace poise::serving {

/// A push forecaster as requests name it.
struct ServedForecaster {
  std::string model;  ///< "statue" or "NAME@VERSION"
  std::shared_ptr<const push::PushForecaster> forecaster;
};

/// Which push forecaster stands behind a name: `statue`, which needs no training, and the trained
/// models of the registry. A trained model is rebuilt when it is first asked for, and kept; who
/// uses one that goes keeps it. Threads: all members may be called from any thread; one model is
/// loaded at a time.
class PushCatalog {
 public:
  /// What an empty name means, where the registry has it; else `statue`.
  static constexpr const char* kDefaultModel = "push-fzj";
  static constexpr const char* kStatue = "statue";

  /// `models` outlives the catalog.
  explicit PushCatalog(const artifacts::ModelRegistry& models) : models_(models) {}

  /// `model` is "", "statue", "NAME" (its default version) or "NAME@VERSION". `overrides` are for
  /// `statue`: a trained model has no settings.
  /// Errors: kInvalidArgument BAD_MODEL_NAME, UNKNOWN_CONFIG_KEY and the other config errors;
  /// kNotFound UNKNOWN_MODEL with the names there are; those of ModelRegistry::Load and
  /// MakeLearnedForecaster; but for config errors all with the field "model".
  StatusOr<ServedForecaster> Find(std::string_view model, const base::Overrides& overrides);

 private:
  static constexpr size_t kMaxLoaded = 8;

  StatusOr<ServedForecaster> FindTrained(const api::ModelReference& reference);
  Status UnknownModel(const std::string& name) const;

  const artifacts::ModelRegistry& models_;
  std::mutex mutex_;
  std::list<ServedForecaster> loaded_;  // the latest used first
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_PUSH_CATALOG_H_
