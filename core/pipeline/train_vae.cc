#include "core/pipeline/train_vae.h"

#include <utility>

#include "core/motion/dataset/clip_set_file.h"
#include "core/pipeline/train_vae_spec.h"
#include "core/synthesis/vae/vae_trainer.h"

namespace poise::pipeline {

StatusOr<TrainedModel> TrainVae(const base::Json& parameters, std::string_view clip_set,
                                const base::RunContext& context,
                                const std::optional<std::string>& checkpoint,
                                const learning::CheckpointSink& sink) {
  POISE_ASSIGN_OR_RETURN(const TrainVaeSpec spec, TrainVaeSpec::FromParameters(parameters));
  synthesis::VaeTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.Config());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet clips,
                         motion::DecodeClipSet(clip_set, spec.data_artifact));
  task.clips = std::move(clips.clips);
  task.fold = {.action_class = spec.action_class, .held_out = spec.hold_out};
  task.preset = spec.preset;
  task.data = spec.data;
  task.data_fingerprint = spec.DataFingerprint();
  task.data_license = spec.data_license;
  POISE_ASSIGN_OR_RETURN(synthesis::VaeResult result,
                         synthesis::TrainVae(task, context, checkpoint, sink));
  TrainedModel trained{
      .model = std::move(result.model),
      .files = {{"learning_curve.csv", "text/csv", std::move(result.curve_csv)},
                {"learning_curve.svg", "image/svg+xml", std::move(result.curve_svg)}}};
  if (!result.latent_map_svg.empty()) {
    trained.files.push_back({"latent_map.svg", "image/svg+xml", std::move(result.latent_map_svg)});
  }
  return trained;
}

}  // namespace poise::pipeline
