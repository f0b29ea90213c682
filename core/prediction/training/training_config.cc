#include "core/prediction/training/training_config.h"

namespace poise::prediction {

std::vector<base::Field> MixerTraining::Fields() {
  std::vector<base::Field> fields = base::Nested("mixer", mixer.Fields());
  base::Append(fields, base::Nested("trainer", trainer.Fields()));
  base::Append(fields, base::Nested("optimizer", optimizer.Fields()));
  base::Append(fields, {base::Number("validation_share", &validation_share, 0, 0.5),
                        base::Flag("mirror", &mirror), base::Flag("speeds", &speeds)});
  return fields;
}

Status MixerTraining::Validate() {
  POISE_RETURN_IF_ERROR(base::CheckRanges(Fields()));
  POISE_RETURN_IF_ERROR(trainer.Validate());
  return optimizer.Validate();
}

}  // namespace poise::prediction
