#include "core/pipeline/train_vae_spec.h"

namespace poise::pipeline {

StatusOr<TrainVaeSpec> TrainVaeSpec::FromParameters(const base::Json& parameters) {
  TrainVaeSpec spec;
  Status status = ReadTrainingSpec(parameters, {}, spec);
  if (status.ok()) status = spec.Config().status();
  if (!status.ok()) return base::Annotate(status, "train_vae", "spec.parameters");
  return spec;
}

}  // namespace poise::pipeline
