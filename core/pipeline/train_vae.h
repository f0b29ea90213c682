#ifndef POISE_CORE_PIPELINE_TRAIN_VAE_H_
#define POISE_CORE_PIPELINE_TRAIN_VAE_H_

#include <optional>
#include <string>
#include <string_view>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/pipeline/train_vae_spec.h"
#include "core/synthesis/vae/vae_trainer.h"

namespace poise::pipeline {

/// From the bytes of a data set to a model with its card. Needs LibTorch: apart from the other
/// flows (poise_training). Errors: those of DecodeClipSet and synthesis::TrainVae.
StatusOr<synthesis::VaeResult> TrainVae(const TrainVaeSpec& spec, std::string_view clip_set,
                                        const base::RunContext& context,
                                        const std::optional<std::string>& checkpoint,
                                        const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_VAE_H_
