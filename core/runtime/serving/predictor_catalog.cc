#include "core/runtime/serving/predictor_catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/config_fields.h"
#include "core/prediction/predictor_registry.h"

namespace poise::serving {
namespace {

constexpr char kBuiltInVersion[] = "1";

}  // namespace

StatusOr<ServedPredictor> PredictorCatalog::Find(std::string_view model) const {
  const size_t at = model.find('@');
  const std::string name(model.substr(0, at));
  const std::string version(at == std::string_view::npos ? "" : model.substr(at + 1));
  std::shared_ptr<const prediction::Predictor> predictor = prediction::FindBuiltInPredictor(name);
  if (predictor == nullptr) {
    const std::vector<std::string> names = prediction::BuiltInPredictorNames();
    const std::string nearest = base::NearestName(name, names);
    return base::NotFound(
        "UNKNOWN_MODEL", "model",
        fmt::format("no model '{}'; there are: {}{}", name, fmt::join(names, ", "),
                    nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }
  if (at != std::string_view::npos && version != kBuiltInVersion) {
    return base::NotFound(
        "UNKNOWN_VERSION", "model",
        fmt::format("model '{}' has no version '{}', only '{}'", name, version, kBuiltInVersion));
  }
  return ServedPredictor{name, kBuiltInVersion, std::move(predictor)};
}

}  // namespace poise::serving
