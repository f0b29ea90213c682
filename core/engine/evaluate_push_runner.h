#ifndef POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_
#define POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_

#include <memory>

#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Kind `evaluate_push`: parameters as pipeline::EvaluatePushSpec; file scores.csv, a row a take
/// and the means; the manifest's report holds the means and what the model has less than the
/// statue.
std::unique_ptr<jobs::JobRunner> MakeEvaluatePushRunner();

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_EVALUATE_PUSH_RUNNER_H_
