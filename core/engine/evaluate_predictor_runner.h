#ifndef POISE_CORE_ENGINE_EVALUATE_PREDICTOR_RUNNER_H_
#define POISE_CORE_ENGINE_EVALUATE_PREDICTOR_RUNNER_H_

#include <memory>

#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kind `evaluate_predictor`: parameters as pipeline::PredictorEvaluation; file scores.csv; the
/// manifest's report is the summary.
class EvaluatePredictorRunner : public jobs::JobRunner {
 public:
  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;
};

std::unique_ptr<jobs::JobRunner> MakeEvaluatePredictorRunner();

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_EVALUATE_PREDICTOR_RUNNER_H_
