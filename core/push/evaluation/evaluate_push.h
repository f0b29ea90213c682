#ifndef POISE_CORE_PUSH_EVALUATION_EVALUATE_PUSH_H_
#define POISE_CORE_PUSH_EVALUATION_EVALUATE_PUSH_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/push/evaluation/forecast_take.h"

namespace poise::push {

/// What one forecaster reached on one set of takes.
struct ForecasterScores {
  ScoreLabels labels;
  std::vector<TakeScores> takes;
  /// By measure (mpjpe, hipade, hipfde, pose_only); only of a trained model, against the statue on
  /// our own pendulum with the same input.
  std::map<std::string, PairedDifference> less_statue = {};
};

/// A trained model and the name it has in results.
struct NamedModel {
  std::string name;
  const artifacts::ModelArtifact& model;
};

/// Forecasts takes by a model of the paper's method: ldp::ForecastTakes, or nothing in programs
/// without LibTorch.
using PaperForecaster = std::function<StatusOr<std::vector<ForecastJoints>>(
    const artifacts::ModelArtifact& model, std::span<const PushTake* const> takes,
    Protocol protocol, const base::RunContext& context)>;

/// Scores forecasters on the takes alone and on those with several people: nobody moves, the statue
/// on the true hip, the statue on our own pendulum, then the models, our own ones also with the
/// recorded hip instead of theirs ("NAME_true_hip"). Each model is told what its card says
/// (protocol), the statue what the first model is (B without one). `takes` are all those to be
/// scored, of either set. Errors: those of MakeLearnedForecaster (WRONG_FAMILY for the paper's
/// models without `paper`), ldp::ForecastTakes and EvaluateForecaster.
StatusOr<std::vector<ForecasterScores>> EvaluatePush(const std::vector<NamedModel>& models,
                                                     std::span<const PushTake* const> takes,
                                                     const base::RunContext& context,
                                                     const PaperForecaster& paper = {});

/// The results file: PushScoresHeader and all rows.
std::string PushScoresCsv(const std::vector<ForecasterScores>& scores);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_EVALUATION_EVALUATE_PUSH_H_
