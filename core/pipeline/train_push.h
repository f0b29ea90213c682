#ifndef POISE_CORE_PIPELINE_TRAIN_PUSH_H_
#define POISE_CORE_PIPELINE_TRAIN_PUSH_H_

#include <optional>
#include <string>
#include <string_view>

#include "core/base/run_context.h"
#include "core/base/status.h"
#include "core/learning/nn/checkpoint_sink.h"
#include "core/pipeline/push_learning_spec.h"
#include "core/push/training/train_push.h"

namespace poise::pipeline {

/// From the bytes of a take file to a push model with its card. Needs LibTorch: apart from the
/// other flows (poise_training). Errors: those of DecodeTakes and push::TrainPush.
StatusOr<push::PushResult> TrainPush(const TrainPushSpec& spec, std::string_view take_file,
                                     const base::RunContext& context,
                                     const std::optional<std::string>& checkpoint,
                                     const learning::CheckpointSink& sink);

}  // namespace poise::pipeline

#endif  // POISE_CORE_PIPELINE_TRAIN_PUSH_H_
