#include "core/pipeline/train_push.h"

#include <utility>
#include <vector>

#include "core/pipeline/push_learning_spec.h"
#include "core/push/presets/train_preset.h"
#include "core/push/takes/take_file.h"

namespace poise::pipeline {

StatusOr<TrainedModel> TrainPush(const base::Json& parameters, std::string_view take_file,
                                 const base::RunContext& context,
                                 const std::optional<std::string>& checkpoint,
                                 const learning::CheckpointSink& sink) {
  POISE_ASSIGN_OR_RETURN(const TrainPushSpec spec, TrainPushSpec::FromParameters(parameters));
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes,
                         push::DecodeTakes(take_file, spec.data_artifact));
  POISE_ASSIGN_OR_RETURN(push::PushResult result,
                         push::TrainPreset({.takes = takes,
                                            .preset = spec.preset,
                                            .overrides = spec.overrides,
                                            .data = spec.data,
                                            .data_fingerprint = spec.DataFingerprint(),
                                            .data_license = spec.data_license},
                                           context, checkpoint, sink));
  return TrainedModel{.model = std::move(result.model),
                      .files = {{"learning_curve.csv", "text/csv", std::move(result.curve_csv)}}};
}

}  // namespace poise::pipeline
