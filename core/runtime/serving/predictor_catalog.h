#ifndef POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
#define POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_

#include <memory>
#include <string>
#include <string_view>

#include "core/base/status.h"
#include "core/prediction/predictor.h"

namespace poise::serving {

/// A predictor as requests name it.
struct ServedPredictor {
  std::string name;
  std::string version;
  std::shared_ptr<const prediction::Predictor> predictor;
};

/// Which predictor stands behind a name.
/// Threads: all members may be called from any thread.
class PredictorCatalog {
 public:
  /// `model` is "NAME" (its newest version) or "NAME@VERSION".
  /// Errors: kNotFound UNKNOWN_MODEL with the names there are, UNKNOWN_VERSION.
  StatusOr<ServedPredictor> Find(std::string_view model) const;
};

}  // namespace poise::serving

#endif  // POISE_CORE_RUNTIME_SERVING_PREDICTOR_CATALOG_H_
