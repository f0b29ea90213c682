#ifndef POISE_CORE_ENGINE_TRAIN_PUSH_RUNNER_H_
#define POISE_CORE_ENGINE_TRAIN_PUSH_RUNNER_H_

#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kind `train_push`: parameters as pipeline::TrainPushSpec; files model.safetensors (which the
/// server gives its name) and learning_curve.csv; the manifest's report holds the card's scores.
class TrainPushRunner : public jobs::JobRunner {
 public:
  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_TRAIN_PUSH_RUNNER_H_
