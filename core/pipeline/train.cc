#include "core/pipeline/train.h"

#include <utility>

#include "core/correction/debias/debias_trainer.h"
#include "core/motion/dataset/clip_set_file.h"
#include "core/motion/dataset/fold.h"
#include "core/synthesis/vae/vae_trainer.h"

namespace poise::pipeline {
namespace {

// What the card says of the data.
template <typename Task>
void DescribeData(const TrainSpec& spec, Task& task) {
  task.preset = spec.preset;
  task.data = spec.data;
  task.data_fingerprint = spec.data_artifact.substr(spec.data_artifact.find('/') + 1);
  task.data_license = spec.data_license;
}

template <typename Result>
TrainedModel WithCurves(Result result) {
  TrainedModel trained{.model = std::move(result.model), .files = {}};
  trained.files.push_back({"learning_curve.csv", "text/csv", std::move(result.curve_csv)});
  trained.files.push_back({"learning_curve.svg", "image/svg+xml", std::move(result.curve_svg)});
  return trained;
}

}  // namespace

StatusOr<TrainedModel> TrainVae(const TrainSpec& spec, std::string_view clip_set,
                                const base::RunContext& context,
                                const std::optional<std::string>& checkpoint,
                                const learning::CheckpointSink& sink) {
  synthesis::VaeTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.ConfigOf<synthesis::VaeConfig>());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet clips,
                         motion::DecodeClipSet(clip_set, spec.data_artifact));
  task.clips = std::move(clips.clips);
  task.fold = {.action_class = spec.action_class, .held_out = spec.hold_out};
  DescribeData(spec, task);
  POISE_ASSIGN_OR_RETURN(synthesis::VaeResult result,
                         synthesis::TrainVae(task, context, checkpoint, sink));
  std::string latent_map = std::move(result.latent_map_svg);
  TrainedModel trained = WithCurves(std::move(result));
  if (!latent_map.empty()) {
    trained.files.push_back({"latent_map.svg", "image/svg+xml", std::move(latent_map)});
  }
  return trained;
}

StatusOr<TrainedModel> TrainDebias(const TrainSpec& spec, std::string_view clip_set,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink) {
  correction::DebiasTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.ConfigOf<correction::DebiasConfig>());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet set, motion::DecodeClipSet(clip_set, spec.data_artifact));
  POISE_ASSIGN_OR_RETURN(const motion::FoldClips fold,
                         motion::ChooseFold(set.clips, {.action_class = spec.action_class,
                                                        .held_out = spec.hold_out}));
  for (const size_t i : fold.train) task.train.push_back(std::move(set.clips[i].clip));
  for (const size_t i : fold.held_out) task.held_out.push_back(std::move(set.clips[i].clip));
  DescribeData(spec, task);
  task.trained_on = fold.description;
  POISE_ASSIGN_OR_RETURN(correction::DebiasResult result,
                         correction::TrainDebias(task, context, checkpoint, sink));
  return WithCurves(std::move(result));
}

}  // namespace poise::pipeline
