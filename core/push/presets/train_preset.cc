#include "core/push/presets/train_preset.h"

#include "core/push/ldp/train_ldp.h"
#include "core/push/presets/check_preset.h"

namespace poise::push {
StatusOr<PushResult> TrainPreset(const PresetTask& task, const base::RunContext& context,
                                 const std::optional<std::string>& checkpoint,
                                 const learning::CheckpointSink& sink) {
  POISE_RETURN_IF_ERROR(CheckPreset(task.preset, task.overrides));
  if (task.preset == ldp::kPreset) {
    POISE_ASSIGN_OR_RETURN(const auto config,
                           ConfigOf<ldp::LdpTraining>(task.preset, task.overrides));
    return ldp::TrainLdp({.takes = task.takes,
                          .config = config,
                          .data = task.data,
                          .data_fingerprint = task.data_fingerprint,
                          .data_license = task.data_license},
                         context, checkpoint, sink);
  }
  POISE_ASSIGN_OR_RETURN(const auto config, ConfigOf<PushTraining>(task.preset, task.overrides));
  return TrainPush({.takes = task.takes,
                    .config = config,
                    .preset = task.preset,
                    .data = task.data,
                    .data_fingerprint = task.data_fingerprint,
                    .data_license = task.data_license},
                   context, checkpoint, sink);
}

}  // namespace poise::push
