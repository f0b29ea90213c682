#ifndef POISE_CORE_ENGINE_CORRECT_RUNNER_H_
#define POISE_CORE_ENGINE_CORRECT_RUNNER_H_

#include <memory>
#include <utility>

#include "core/api/correct_spec.h"
#include "core/base/json.h"
#include "core/engine/decoder_cache.h"
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
  /// Without `make_learner` the effort full is refused, without `load_decoder` the step "vae":
  /// kFailedPrecondition NO_NETWORKS.
  explicit CorrectRunner(pipeline::PolicyLearnerFactory make_learner = {},
                         DecoderLoader load_decoder = {})
      : make_learner_(std::move(make_learner)), load_decoder_(std::move(load_decoder)) {}

  StatusOr<jobs::RunOutput> Run(const jobs::RunInput& input,
                                const jobs::JobContext& context) override;

 private:
  // The network that the spec names; none where it names none.
  StatusOr<pipeline::MotionDecoderPtr> Decoder(const api::CorrectSpec& spec,
                                               const jobs::RunInput& input) const;

  const pipeline::PolicyLearnerFactory make_learner_;
  const DecoderLoader load_decoder_;
};

/// For the flow table. The runner has no networks.
std::unique_ptr<jobs::JobRunner> MakeCorrectRunner();
Status ValidateCorrect(const base::Json& parameters);
/// Whether a policy is to be learned, or a network makes the variants.
bool CorrectNeedsTorch(const base::Json& parameters);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_CORRECT_RUNNER_H_
