#ifndef POISE_CORE_PIPELINE_TRAINED_MODEL_H_
#define POISE_CORE_PIPELINE_TRAINED_MODEL_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/base/json.h"
#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"

namespace poise::pipeline {

/// What a training gives: a model with its card, and files about it.
struct TrainedModel {
  struct File {
    std::string name;  ///< "learning_curve.csv"
    std::string media_type;
    std::string bytes;
  };
  artifacts::ModelArtifact model;
  std::vector<File> files;
};

/// Trains by the parameters of a job on the bytes of a data set, with the seed of `context`.
/// `checkpoint` is what an earlier attempt gave to `sink`.
using Training = StatusOr<TrainedModel> (*)(const base::Json& parameters, std::string_view clip_set,
                                            const base::RunContext& context,
                                            const std::optional<std::string>& checkpoint,
                                            const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAINED_MODEL_H_
