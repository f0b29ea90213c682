#include "core/pipeline/train_predictor_spec.h"

namespace poise::pipeline {

StatusOr<TrainPredictorSpec> TrainPredictorSpec::FromParameters(const base::Json& parameters) {
  TrainPredictorSpec spec;
  Status status = ReadTrainingSpec(parameters, spec.form.Fields(), spec);
  if (status.ok()) status = spec.Config().status();
  if (!status.ok()) return base::Annotate(status, "train_predictor", "spec.parameters");
  return spec;
}

}  // namespace poise::pipeline
