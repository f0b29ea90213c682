#include "core/pipeline/train_vae.h"

#include <utility>

#include "core/motion/dataset/clip_set_file.h"

namespace poise::pipeline {

StatusOr<synthesis::VaeResult> TrainVae(const TrainVaeSpec& spec, std::string_view clip_set,
                                        const base::RunContext& context,
                                        const std::optional<std::string>& checkpoint,
                                        const learning::CheckpointSink& sink) {
  synthesis::VaeTask task;
  POISE_ASSIGN_OR_RETURN(task.config, spec.Config());
  POISE_ASSIGN_OR_RETURN(motion::ClipSet clips,
                         motion::DecodeClipSet(clip_set, spec.data_artifact));
  task.clips = std::move(clips.clips);
  task.fold = {.action_class = spec.action_class, .held_out = spec.hold_out};
  task.preset = spec.preset;
  task.data = spec.data;
  task.data_fingerprint = spec.data_artifact.substr(spec.data_artifact.find('/') + 1);
  task.data_license = spec.data_license;
  return synthesis::TrainVae(task, context, checkpoint, sink);
}

}  // namespace poise::pipeline
