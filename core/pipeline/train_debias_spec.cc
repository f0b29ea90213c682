#include "core/pipeline/train_debias_spec.h"

namespace poise::pipeline {

StatusOr<TrainDebiasSpec> TrainDebiasSpec::FromParameters(const base::Json& parameters) {
  TrainDebiasSpec spec;
  Status status = ReadTrainingSpec(parameters, {}, spec);
  if (status.ok()) status = spec.Config().status();
  if (!status.ok()) return base::Annotate(status, "train_debias", "spec.parameters");
  return spec;
}

}  // namespace poise::pipeline
