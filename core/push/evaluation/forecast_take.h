#ifndef POISE_CORE_PUSH_EVALUATION_FORECAST_TAKE_H_
#define POISE_CORE_PUSH_EVALUATION_FORECAST_TAKE_H_

#include <span>
#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/push/evaluation/take_scores.h"
#include "core/push/learned/push_networks.h"
#include "core/push/push_forecaster.h"
#include "core/push/takes/push_protocol.h"

namespace poise::push {

/// What a forecaster may know of a take: everybody in frame 0 and the push by the protocol.
/// `random` draws protocol C's noise.
PushScene SceneOf(const PushTake& take, Protocol protocol, base::Random& random);

/// Errors: those of PushRollout; kCancelled, kDeadlineExceeded.
StatusOr<ForecastJoints> ForecastTake(const PushForecaster& forecaster, const PushTake& take,
                                      Protocol protocol, const base::RunContext& context);

/// Bodies as a trained model puts them on the recorded hips: what it would do if it knew those.
ForecastJoints ForecastOnTrueHip(const PushNetworks& networks, const PushTake& take);

/// Forecasts takes with the seed of `context` and scores them, in order; reports progress.
StatusOr<std::vector<TakeScores>> EvaluateForecaster(const PushForecaster& forecaster,
                                                     std::span<const PushTake* const> takes,
                                                     Protocol protocol,
                                                     const base::RunContext& context);

/// Rows of a results file: a header; one row a take, then the mean over takes ("mean") and without
/// the outliers ("mean_without_outliers"). The labels stand in the first columns.
struct ScoreLabels {
  std::string model;
  std::string protocol;
  std::string set;  ///< "single" or "several"
  uint64_t seed = 0;
};
std::string PushScoresHeader();
std::string PushScoresRows(const ScoreLabels& labels, std::span<const TakeScores> scores);

/// How much lower one forecaster's measure is than another's on the same takes.
struct PairedDifference {
  double mean = 0;           ///< ours less theirs, mean over takes
  double low = 0, high = 0;  ///< 90 % interval, bootstrap over takes
  double better_share = 0;   ///< of takes in which ours is lower
};
/// Precondition: the same takes in the same order.
PairedDifference Compare(std::span<const TakeScores> ours, std::span<const TakeScores> theirs,
                         const std::string& measure, uint64_t seed);

}  // namespace poise::push

#endif  // POISE_CORE_PUSH_EVALUATION_FORECAST_TAKE_H_
