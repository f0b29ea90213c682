#include "core/prediction/training/training_config.h"

#include <fmt/format.h>

namespace poise::prediction {

StatusOr<PredictorTraining> PredictorTraining::FromPreset(std::string_view name) {
  if (name == "recommended") return PredictorTraining();
  return base::InvalidArgument("UNKNOWN_PRESET", "preset",
                               fmt::format("unknown preset '{}', expected recommended", name));
}

std::vector<base::Field> PredictorTraining::Fields() {
  std::vector<base::Field> fields = {base::Text("family", &family, {"mixer"}),
                                     base::Number("members", &members, 1, 64)};
  base::Append(fields, base::Nested("mixer", mixer.Fields()));
  base::Append(fields, base::Nested("trainer", trainer.Fields()));
  base::Append(fields, base::Nested("optimizer", optimizer.Fields()));
  base::Append(fields, {base::Number("validation_share", &validation_share, 0, 0.5),
                        base::Number("least_future_frames", &least_future_frames, 1, 1000),
                        base::Flag("mirror", &mirror), base::Flag("speeds", &speeds)});
  return fields;
}

Status PredictorTraining::Validate() {
  POISE_RETURN_IF_ERROR(base::CheckRanges(Fields()));
  POISE_RETURN_IF_ERROR(mixer.Validate());
  POISE_RETURN_IF_ERROR(trainer.Validate());
  return optimizer.Validate();
}

}  // namespace poise::prediction
