#ifndef POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_
#define POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/prediction/predictor.h"

namespace poise::prediction {

using PredictorPtr = std::shared_ptr<const Predictor>;

/// Names of the predictors that need no training: "zero-velocity", "constant-velocity".
std::vector<std::string> BuiltInPredictorNames();

/// One of them, or null when `name` is none.
PredictorPtr FindBuiltInPredictor(std::string_view name);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_
