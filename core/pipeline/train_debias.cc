#include "core/pipeline/train_debias.h"

#include <utility>

#include "core/correction/debias/debias_trainer.h"
#include "core/motion/dataset/clip_set_file.h"
#include "core/motion/dataset/fold.h"
#include "core/pipeline/train_debias_spec.h"

namespace poise::pipeline {

StatusOr<TrainedModel> TrainDebias(const base::Json& parameters, std::string_view clip_set,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink) {
  POISE_ASSIGN_OR_RETURN(const TrainDebiasSpec spec, TrainDebiasSpec::FromParameters(parameters));
  correction::DebiasTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.Config());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet set, motion::DecodeClipSet(clip_set, spec.data_artifact));
  POISE_ASSIGN_OR_RETURN(const motion::FoldClips fold,
                         motion::ChooseFold(set.clips, {.action_class = spec.action_class,
                                                        .held_out = spec.hold_out}));
  for (const auto& [indices, clips] :
       {std::pair(&fold.train, &task.train), std::pair(&fold.held_out, &task.held_out)}) {
    for (const size_t i : *indices) {
      clips->push_back({std::move(set.clips[i].clip), std::move(set.clips[i].actor)});
    }
  }
  task.preset = spec.preset;
  task.data = spec.data;
  task.data_fingerprint = spec.DataFingerprint();
  task.data_license = spec.data_license;
  task.trained_on = fold.description;
  POISE_ASSIGN_OR_RETURN(correction::DebiasResult result,
                         correction::TrainDebias(task, context, checkpoint, sink));
  return TrainedModel{
      .model = std::move(result.model),
      .files = {{"learning_curve.csv", "text/csv", std::move(result.curve_csv)},
                {"learning_curve.svg", "image/svg+xml", std::move(result.curve_svg)}}};
}

}  // namespace poise::pipeline
