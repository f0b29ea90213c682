#ifndef POISE_CORE_PIPELINE_PREDICTOR_EVALUATION_H_
#define POISE_CORE_PIPELINE_PREDICTOR_EVALUATION_H_

#include <string>
#include <string_view>

#include "core/artifacts/model_artifact.h"
#include "core/base/json.h"
#include "core/base/run_context.h"
#include "core/motion/dataset/benchmark_clips.h"

namespace poise::pipeline {

/// The parameters of a job of kind `evaluate_predictor`: what is tested on what.
struct PredictorEvaluation {
  std::string model;           ///< "NAME@VERSION"; empty: the floors alone
  std::string model_artifact;  ///< "artifacts/<sha256>": its file, if there is a model
  std::string data;            ///< name of the data set, for people
  std::string data_artifact;   ///< "artifacts/<sha256>": its clips
  std::string action_class;    ///< "kick"; empty: all clips
  std::string hold_out;        ///< actor whose clips are the test; empty: all clips are
  /// Of another data set, all of which is for training: whose columns move, and which actions were
  /// trained on, it says. Empty: the clips that are not held out, or all.
  std::string train_artifact;
  std::string protocol = "loso";  ///< motion::FindProtocol
  motion::BenchmarkForm form;     ///< "frame_rate" and "body": those of the model

  /// Errors: kInvalidArgument with a field below "spec.parameters": UNKNOWN_CONFIG_KEY,
  /// MALFORMED_CONFIG_VALUE, CONFIG_VALUE_OUT_OF_RANGE, MISSING_DATA, UNKNOWN_PROTOCOL.
  static StatusOr<PredictorEvaluation> FromParameters(const base::Json& parameters);

  /// What is tested, and what tells the columns. Errors: those of DecodeClipSet and MakeBenchmark.
  StatusOr<motion::BenchmarkClips> Clips(std::string_view clip_set,
                                         std::string_view train_set) const;
};

struct EvaluationReport {
  std::string csv;  ///< rows of ScoresCsvRows under their header
  /// {"protocol", "horizons_ms": [...], "models": [{"model", "preset", "windows", "errors":
  /// [...]}]} with the mean over actions at the frames that the protocol shows; null beyond a
  /// model's horizon. Models as tested: the floors, then the model.
  base::Json summary;
};

/// Tests the floors, and `model` unless null.
/// Errors: those of EvaluatePredictor and MakeTrainedPredictor; kFailedPrecondition NO_WINDOWS (no
/// clip is as long as a window of the protocol).
StatusOr<EvaluationReport> Evaluate(const PredictorEvaluation& evaluation,
                                    const motion::BenchmarkClips& clips,
                                    const artifacts::ModelArtifact* model,
                                    const base::RunContext& context);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_PREDICTOR_EVALUATION_H_
