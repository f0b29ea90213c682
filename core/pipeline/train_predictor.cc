#include "core/pipeline/train_predictor.h"

#include <utility>

#include "core/motion/dataset/clip_set_file.h"
#include "core/pipeline/train_predictor_spec.h"
#include "core/prediction/training/train_predictor.h"

namespace poise::pipeline {

StatusOr<TrainedModel> TrainPredictor(const base::Json& parameters, std::string_view clip_set,
                                      const base::RunContext& context,
                                      const std::optional<std::string>& checkpoint,
                                      const learning::CheckpointSink& sink) {
  POISE_ASSIGN_OR_RETURN(const TrainPredictorSpec spec,
                         TrainPredictorSpec::FromParameters(parameters));
  prediction::PredictorTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.Config());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet clips,
                         motion::DecodeClipSet(clip_set, spec.data_artifact));
  POISE_ASSIGN_OR_RETURN(
      task.clips, motion::MakeBenchmark(std::move(clips.clips), {.action_class = spec.action_class,
                                                                 .hold_out = spec.hold_out,
                                                                 .form = spec.form}));
  task.preset = spec.preset;
  task.data = spec.data;
  task.data_fingerprint = spec.DataFingerprint();
  task.data_license = spec.data_license;
  task.trained_on = spec.TrainedOn();
  POISE_ASSIGN_OR_RETURN(prediction::PredictorResult result,
                         prediction::TrainPredictor(task, context, checkpoint, sink));
  return TrainedModel{
      .model = std::move(result.model),
      .files = {{"learning_curve.csv", "text/csv", std::move(result.curve_csv)},
                {"learning_curve.svg", "image/svg+xml", std::move(result.curve_svg)}}};
}

}  // namespace poise::pipeline
