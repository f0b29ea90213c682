#ifndef POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_
#define POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/prediction/predictor.h"

namespace poise::prediction {

using PredictorPtr = std::shared_ptr<const Predictor>;

/// Names of the predictors that need no training: "zero-velocity", "constant-velocity".
std::vector<std::string> BuiltInPredictorNames();

/// One of them, or null when `name` is none.
PredictorPtr FindBuiltInPredictor(std::string_view name);

/// Rebuilds a trained predictor: its family and sizes from the card's config (PredictorTraining),
/// its body from the card's normalisation ("body"), its numbers from the weights. An ensemble keeps
/// those of its members below "member0.", "member1.", ...
/// Errors: kFailedPrecondition WRONG_FAMILY (the model predicts nothing); kInvalidArgument
/// MALFORMED_CARD, MISSING_TENSOR, WRONG_SHAPE; config errors.
StatusOr<PredictorPtr> MakeTrainedPredictor(const artifacts::ModelArtifact& model);

}  // namespace poise::prediction

#endif  // POISE_CORE_PREDICTION_PREDICTOR_REGISTRY_H_
