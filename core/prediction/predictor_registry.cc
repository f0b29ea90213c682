#include "core/prediction/predictor_registry.h"

#include "core/prediction/constant_velocity/constant_velocity.h"
#include "core/prediction/zero_velocity/zero_velocity.h"

namespace poise::prediction {
namespace {

template <typename Family>
PredictorPtr Make() {
  return std::make_shared<Family>();
}

struct Entry {
  const char* name;
  PredictorPtr (*make)();
};

constexpr Entry kBuiltIn[] = {
    {"zero-velocity", Make<ZeroVelocity>},
    {"constant-velocity", Make<ConstantVelocity>},
};

}  // namespace

std::vector<std::string> BuiltInPredictorNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBuiltIn) names.push_back(entry.name);
  return names;
}

PredictorPtr FindBuiltInPredictor(std::string_view name) {
  for (const Entry& entry : kBuiltIn) {
    if (name == entry.name) return entry.make();
  }
  return nullptr;
}

}  // namespace poise::prediction
