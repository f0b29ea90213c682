#include "core/pipeline/train_push.h"

#include <vector>

#include "core/push/takes/take_file.h"

namespace poise::pipeline {

StatusOr<push::PushResult> TrainPush(const TrainPushSpec& spec, std::string_view take_file,
                                     const base::RunContext& context,
                                     const std::optional<std::string>& checkpoint,
                                     const learning::CheckpointSink& sink) {
  POISE_ASSIGN_OR_RETURN(const push::PushTraining config, spec.Config());
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes,
                         push::DecodeTakes(take_file, spec.data_artifact));
  return push::TrainPush(
      {.takes = takes,
       .config = config,
       .preset = spec.preset,
       .data = spec.data,
       .data_fingerprint = spec.data_artifact.substr(spec.data_artifact.find('/') + 1),
       .data_license = spec.data_license},
      context, checkpoint, sink);
}

}  // namespace poise::pipeline
