#ifndef POISE_CORE_PIPELINE_EVALUATE_PREDICTOR_H_
#define POISE_CORE_PIPELINE_EVALUATE_PREDICTOR_H_

#include <string>
#include <vector>

#include "core/base/run_context.h"
#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/dataset/windows.h"
#include "core/prediction/predictor.h"

namespace poise::pipeline {

/// Error of a predictor on one action, a value per output frame.
struct ActionErrors {
  std::string action;
  int windows = 0;
  bool trained_on = false;     ///< the benchmark has training sequences of this action
  std::vector<double> errors;  ///< (future frames) mean over windows of the Euler error [rad]
};

struct PredictorScores {
  std::vector<ActionErrors> actions;
  /// (future frames) mean over the actions that are trained on, each with the same weight.
  std::vector<double> mean;
};

/// Tests a predictor by a published protocol: it sees the end of each window's past and predicts to
/// the window's end, or as far as it can.
/// Source: reference sec. 1.7 and 1.8.
/// Errors: kFailedPrecondition PAST_TOO_LONG (it looks at more than the window's past),
/// HORIZON_TOO_SHORT (it does not reach the frames that the protocol shows), WRONG_BENCHMARK (other
/// joints or another rate); those of the predictor and of TestStarts.
StatusOr<PredictorScores> EvaluatePredictor(const prediction::Predictor& predictor,
                                            const motion::BenchmarkClips& clips,
                                            const motion::EvaluationProtocol& protocol,
                                            const base::RunContext& context);

/// What a row of a results file says beside the score.
struct ScoreLabels {
  std::string model;   ///< "NAME@VERSION"
  std::string preset;  ///< empty for floors
  uint64_t seed = 0;
};

/// The header and a row per action (and "mean") and frame that the protocol shows: columns
/// task,model,preset,protocol,action,frame,horizon_ms,seed,metric,value.
std::string ScoresCsvHeader();
std::string ScoresCsvRows(const PredictorScores& scores, const ScoreLabels& labels,
                          const motion::EvaluationProtocol& protocol, double frame_rate);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_EVALUATE_PREDICTOR_H_
