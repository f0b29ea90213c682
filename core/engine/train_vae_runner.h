#ifndef POISE_CORE_ENGINE_TRAIN_VAE_RUNNER_H_
#define POISE_CORE_ENGINE_TRAIN_VAE_RUNNER_H_

#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kind `train_vae`: parameters as pipeline::TrainVaeSpec; files model.safetensors (which
/// the server gives its name), learning_curve.csv and .svg, latent_map.svg; the manifest's report
/// holds the card's scores.
class TrainVaeRunner : public jobs::JobRunner {
 public:
  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_TRAIN_VAE_RUNNER_H_
