#ifndef POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_
#define POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_

#include <memory>

#include "core/pipeline/evaluate_push.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kind `evaluate_push`: parameters as pipeline::EvaluatePushSpec; file scores.csv, a row a take
/// and the means; the manifest's report holds the means and what the model has less than the
/// statue.
std::unique_ptr<jobs::JobRunner> MakeEvaluatePushRunner(push::PaperForecaster paper);
/// For the flow table: scores only what needs no LibTorch.
std::unique_ptr<jobs::JobRunner> MakeLightEvaluatePushRunner();
/// Whether there is a model, which may be one of the paper's method.
bool EvaluatePushNeedsTorch(const base::Json& parameters);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_
