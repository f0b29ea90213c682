#include "core/engine/flow_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/engine/correct_runner.h"
#include "core/pipeline/train_spec.h"
#include "core/runtime/jobs/selftest_config.h"
#include "core/runtime/jobs/selftest_runner.h"

namespace poise::engine {

const std::vector<Flow>& FlowTable() {
  static const std::vector<Flow> flows = {
      {"selftest", "steps that do nothing, for tests of the job system", jobs::ValidateSelftest,
       jobs::MakeSelftestRunner},
      {"correct", "variants of clips that a simulated body has imitated", ValidateCorrect,
       MakeCorrectRunner, CorrectNeedsTorch},
      {"train_vae", "a variational autoencoder of one class's motions", pipeline::CheckTrainVae,
       nullptr, nullptr, /*trains=*/true},
      {"train_debias", "undoes what imitation changes about a class's motions",
       pipeline::CheckTrainDebias, nullptr, nullptr, /*trains=*/true},
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
