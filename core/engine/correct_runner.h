#ifndef POISE_CORE_ENGINE_CORRECT_RUNNER_H_
#define POISE_CORE_ENGINE_CORRECT_RUNNER_H_

#include <memory>
#include <utility>

#include "core/base/json.h"
#include "core/pipeline/correct.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// Runs jobs of kind `correct`: the parameters are an api::CorrectSpec whose sources are artifacts,
/// the files are the corrected variants as BVH in the form of their source, and the report is
/// {"clips": [api::CorrectedClipReport]}. What is done goes into checkpoints.
/// Errors: those of the readers of clips with the field "sources[i]", of CorrectFlow and
/// CorrectRun; kNotFound INPUT_NOT_FOUND; kDataLoss CORRUPT_CHECKPOINT.
class CorrectRunner : public jobs::JobRunner {
 public:
  /// Without `make_learner` the effort full is refused: kFailedPrecondition NO_NETWORKS.
  explicit CorrectRunner(pipeline::PolicyLearnerFactory make_learner = {})
      : make_learner_(std::move(make_learner)) {}

  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;

 private:
  const pipeline::PolicyLearnerFactory make_learner_;
};

/// For the flow table. The runner learns no policies.
std::unique_ptr<jobs::JobRunner> MakeCorrectRunner();
Status ValidateCorrect(const base::Json& parameters);
/// Whether a policy is to be learned.
bool CorrectNeedsTorch(const base::Json& parameters);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_CORRECT_RUNNER_H_
