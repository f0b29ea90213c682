#ifndef POISE_CORE_ENGINE_TRAIN_RUNNER_H_
#define POISE_CORE_ENGINE_TRAIN_RUNNER_H_

#include <functional>
#include <string>
#include <utility>

#include "core/pipeline/train.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// A kind of job that trains: parameters as pipeline::TrainSpec; files model.safetensors (which
/// the server gives its name) and those of pipeline::TrainedModel; the manifest's report holds the
/// card's scores.
class TrainRunner : public jobs::JobRunner {
 public:
  /// pipeline::TrainVae, pipeline::TrainDebias
  using Training = decltype(&pipeline::TrainVae);

  /// `kind` is for messages.
  TrainRunner(std::string kind, Training train) : kind_(std::move(kind)), train_(train) {}

  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;

 private:
  const std::string kind_;
  const Training train_;
};

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_TRAIN_RUNNER_H_
