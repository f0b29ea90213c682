#ifndef POISE_CORE_ENGINE_TRAINING_RUNNER_H_
#define POISE_CORE_ENGINE_TRAINING_RUNNER_H_

#include "core/pipeline/trained_model.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kinds `train_vae` and `train_predictor`: files model.safetensors (which the server gives its
/// name) and those of the training; the manifest's report holds the card's scores.
class TrainingRunner : public jobs::JobRunner {
 public:
  explicit TrainingRunner(pipeline::Training train) : train_(train) {}

  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;

 private:
  const pipeline::Training train_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_TRAINING_RUNNER_H_
