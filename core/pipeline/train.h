#ifndef POISE_CORE_PIPELINE_TRAIN_H_
#define POISE_CORE_PIPELINE_TRAIN_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/pipeline/train_spec.h"

/// From the bytes of a data set to a model with its card. Need LibTorch: apart from the other flows
/// (poise_training).
namespace poise::pipeline {

struct TrainedModel {
  /// What a training leaves beside the model: "learning_curve.csv" and .svg, "latent_map.svg".
  struct File {
    std::string name, media_type, bytes;
  };
  artifacts::ModelArtifact model;
  std::vector<File> files;
};

/// Errors: those of DecodeClipSet and synthesis::TrainVae.
StatusOr<TrainedModel> TrainVae(const TrainSpec& spec, std::string_view clip_set,
                                const base::RunContext& context,
                                const std::optional<std::string>& checkpoint,
                                const learning::CheckpointSink& sink);

/// Errors: those of DecodeClipSet, motion::ChooseFold and correction::TrainDebias.
StatusOr<TrainedModel> TrainDebias(const TrainSpec& spec, std::string_view clip_set,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_H_
