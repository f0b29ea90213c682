#ifndef POISE_CORE_PIPELINE_TRAIN_PUSH_H_
#define POISE_CORE_PIPELINE_TRAIN_PUSH_H_

#include "core/pipeline/trained_model.h"

namespace poise::pipeline {

/// A Training of networks that forecast pushes; `parameters` are a TrainPushSpec's, `take_file` the
/// bytes of a take file. Errors: those of TrainPushSpec::FromParameters, DecodeTakes and
/// push::TrainPreset.
StatusOr<TrainedModel> TrainPush(const base::Json& parameters, std::string_view take_file,
                                 const base::RunContext& context,
                                 const std::optional<std::string>& checkpoint,
                                 const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_PUSH_H_
