#ifndef POISE_CORE_PIPELINE_TRAIN_DEBIAS_H_
#define POISE_CORE_PIPELINE_TRAIN_DEBIAS_H_

#include "core/pipeline/trained_model.h"

namespace poise::pipeline {

/// A Training by TrainDebiasSpec. Needs LibTorch: apart from the other flows (poise_training).
/// Errors: those of TrainDebiasSpec::FromParameters, DecodeClipSet, motion::ChooseFold and
/// correction::TrainDebias.
StatusOr<TrainedModel> TrainDebias(const base::Json& parameters, std::string_view clip_set,
                                   const base::RunContext& context,
                                   const std::optional<std::string>& checkpoint,
                                   const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_DEBIAS_H_
