#include "core/engine/flow_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/engine/correct_runner.h"
#include "core/engine/evaluate_predictor_runner.h"
#include "core/engine/evaluate_push_runner.h"
#include "core/pipeline/predictor_evaluation.h"
#include "core/pipeline/push_learning_spec.h"
#include "core/pipeline/train_debias_spec.h"
#include "core/pipeline/train_predictor_spec.h"
#include "core/pipeline/train_vae_spec.h"
#include "core/runtime/jobs/selftest_config.h"
#include "core/runtime/jobs/selftest_runner.h"

namespace poise::engine {

namespace {

template <typename Spec>
Status Validate(const base::Json& parameters) {
  return Spec::FromParameters(parameters).status();
}

}  // namespace

const std::vector<Flow>& FlowTable() {
  static const std::vector<Flow> flows = {
      {"selftest", "steps that do nothing, for tests of the job system", jobs::ValidateSelftest,
       jobs::MakeSelftestRunner},
      {"correct", "variants of clips that a simulated body has imitated", ValidateCorrect,
       MakeCorrectRunner, CorrectNeedsTorch},
      {"train_push", "networks that forecast what people do after a push",
       Validate<pipeline::TrainPushSpec>, nullptr, nullptr, /*trains=*/true},
      {"evaluate_push", "scores of push forecasts on recorded takes",
       Validate<pipeline::EvaluatePushSpec>, MakeLightEvaluatePushRunner, EvaluatePushNeedsTorch},
      {"train_vae", "a variational autoencoder of one class's motions",
       Validate<pipeline::TrainVaeSpec>, nullptr, nullptr, /*trains=*/true},
      {"train_debias", "undoes what imitation changes about a class's motions",
       Validate<pipeline::TrainDebiasSpec>, nullptr, nullptr, /*trains=*/true},
      {"train_predictor", "a network that says what comes next in a motion",
       Validate<pipeline::TrainPredictorSpec>, nullptr, nullptr, /*trains=*/true},
      {"evaluate_predictor", "how far predictions are from what came, beside the floors",
       Validate<pipeline::PredictorEvaluation>, MakeEvaluatePredictorRunner},
  };
  return flows;
}

StatusOr<const Flow*> FindFlow(std::string_view kind) {
  std::vector<std::string_view> kinds;
  for (const Flow& flow : FlowTable()) {
    if (flow.kind == kind) return &flow;
    kinds.push_back(flow.kind);
  }
  return base::InvalidArgument(
      "UNKNOWN_JOB_KIND", "spec.kind",
      fmt::format("unknown kind of job '{}', expected one of: {}", kind, fmt::join(kinds, ", ")));
}

StatusOr<std::unique_ptr<jobs::JobRunner>> MakeLightRunner(std::string_view kind) {
  POISE_ASSIGN_OR_RETURN(const Flow* flow, FindFlow(kind));
  if (flow->make_runner != nullptr) return flow->make_runner();
  return base::FailedPrecondition("NO_NETWORKS", "spec.kind",
                                  fmt::format("this program runs no jobs of kind '{}'", kind));
}

bool NeedsTorch(const api::JobSpec& spec) {
  const StatusOr<const Flow*> flow = FindFlow(spec.kind);
  if (!flow.ok()) return false;
  if ((*flow)->needs_torch != nullptr) return (*flow)->needs_torch(spec.parameters);
  return (*flow)->make_runner == nullptr;
}

}  // namespace poise::engine
