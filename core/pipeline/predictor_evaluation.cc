#include "core/pipeline/predictor_evaluation.h"

#include <utility>

#include "core/motion/dataset/clip_set_file.h"
#include "core/motion/dataset/windows.h"
#include "core/pipeline/evaluate_predictor.h"
#include "core/prediction/predictor_registry.h"

namespace poise::pipeline {
namespace {

/// Tests one predictor after the other.
class Tester {
 public:
  Tester(const motion::BenchmarkClips& clips, const motion::EvaluationProtocol& protocol)
      : clips_(clips),
        protocol_(protocol),
        frame_rate_(clips.test.front().clip.frame_rate()),
        report_{ScoresCsvHeader(),
                {{"protocol", protocol.name},
                 {"horizons_ms", base::Json::array()},
                 {"models", base::Json::array()}}} {
    for (const int frame : protocol_.frames) {
      report_.summary["horizons_ms"].push_back(1000 * (frame + 1) / frame_rate_);
    }
  }

  Status Test(const prediction::Predictor& predictor, const ScoreLabels& labels,
              const base::RunContext& context) {
    POISE_ASSIGN_OR_RETURN(const PredictorScores scores,
                           EvaluatePredictor(predictor, clips_, protocol_, context));
    if (scores.actions.empty()) {
      return base::FailedPrecondition(
          "NO_WINDOWS", "protocol", "no clip is as long as a window of protocol " + protocol_.name);
    }
    report_.csv += ScoresCsvRows(scores, labels, protocol_, frame_rate_);
    base::Json errors = base::Json::array();
    for (const size_t frame : protocol_.frames) {
      errors.push_back(frame < scores.mean.size() ? base::Json(scores.mean[frame]) : base::Json());
    }
    int windows = 0;
    for (const ActionErrors& action : scores.actions) windows += action.windows;
    report_.summary["models"].push_back({{"model", labels.model},
                                         {"preset", labels.preset},
                                         {"windows", windows},
                                         {"errors", std::move(errors)}});
    return absl::OkStatus();
  }

  EvaluationReport Take() { return std::move(report_); }

 private:
  const motion::BenchmarkClips& clips_;
  const motion::EvaluationProtocol& protocol_;
  const double frame_rate_;
  EvaluationReport report_;
};

StatusOr<PredictorEvaluation> Parse(const base::Json& parameters) {
  PredictorEvaluation e;
  std::vector<base::Field> fields = {base::Text("model", &e.model),
                                     base::Text("model_artifact", &e.model_artifact),
                                     base::Text("data", &e.data),
                                     base::Text("data_artifact", &e.data_artifact),
                                     base::Text("action_class", &e.action_class),
                                     base::Text("hold_out", &e.hold_out),
                                     base::Text("train_artifact", &e.train_artifact),
                                     base::Text("protocol", &e.protocol)};
  base::Append(fields, e.form.Fields());
  POISE_RETURN_IF_ERROR(base::FieldsFromJson(parameters, std::move(fields)));
  POISE_RETURN_IF_ERROR(motion::FindProtocol(e.protocol).status());
  if (!e.data_artifact.empty()) return e;
  return base::InvalidArgument("MISSING_DATA", "data_artifact",
                               "say what to test on: the artifact of a data set");
}

}  // namespace

StatusOr<PredictorEvaluation> PredictorEvaluation::FromParameters(const base::Json& parameters) {
  StatusOr<PredictorEvaluation> evaluation = Parse(parameters);
  if (evaluation.ok()) return evaluation;
  return base::Annotate(evaluation.status(), "evaluate_predictor", "spec.parameters");
}

StatusOr<motion::BenchmarkClips> PredictorEvaluation::Clips(std::string_view clip_set,
                                                            std::string_view train_set) const {
  POISE_ASSIGN_OR_RETURN(motion::ClipSet tested, motion::DecodeClipSet(clip_set, data_artifact));
  POISE_ASSIGN_OR_RETURN(
      motion::BenchmarkClips clips,
      motion::MakeBenchmark(std::move(tested.clips),
                            {.action_class = action_class, .hold_out = hold_out, .form = form}));
  if (clips.test.empty()) clips.test = clips.train;
  if (train_artifact.empty()) return clips;
  POISE_ASSIGN_OR_RETURN(motion::ClipSet train, motion::DecodeClipSet(train_set, train_artifact));
  POISE_ASSIGN_OR_RETURN(
      motion::BenchmarkClips learned,
      motion::MakeBenchmark(std::move(train.clips), {.action_class = action_class, .form = form}));
  learned.test = std::move(clips.test);
  return learned;
}

StatusOr<EvaluationReport> Evaluate(const PredictorEvaluation& evaluation,
                                    const motion::BenchmarkClips& clips,
                                    const artifacts::ModelArtifact* model,
                                    const base::RunContext& context) {
  POISE_ASSIGN_OR_RETURN(const motion::EvaluationProtocol protocol,
                         motion::FindProtocol(evaluation.protocol));
  Tester tester(clips, protocol);
  const std::vector<std::string> floors = prediction::BuiltInPredictorNames();
  const auto total = static_cast<int64_t>(floors.size()) + (model != nullptr ? 1 : 0);
  int64_t done = 0;
  for (const std::string& name : floors) {
    context.Report({.step = done++, .total = total, .message = "testing " + name});
    POISE_RETURN_IF_ERROR(
        tester.Test(*prediction::FindBuiltInPredictor(name), {name + "@1", "", 0}, context));
  }
  if (model != nullptr) {
    context.Report({.step = done++, .total = total, .message = "testing " + evaluation.model});
    POISE_ASSIGN_OR_RETURN(const auto predictor, prediction::MakeTrainedPredictor(*model));
    POISE_RETURN_IF_ERROR(
        tester.Test(*predictor, {evaluation.model, model->card.preset, model->card.seed}, context));
  }
  context.Report({.step = total, .total = total, .message = "tested"});
  return tester.Take();
}

}  // namespace poise::pipeline
