#include "core/engine/flow_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/engine/correct_runner.h"
#include "core/pipeline/train_vae_spec.h"
#include "core/runtime/jobs/selftest_config.h"
#include "core/runtime/jobs/selftest_runner.h"

namespace poise::engine {

namespace {

Status ValidateTrainVae(const base::Json& parameters) {
  return pipeline::TrainVaeSpec::FromParameters(parameters).status();
}

}  // namespace

const std::vector<Flow>& FlowTable() {
  static const std::vector<Flow> flows = {
      {"selftest", "steps that do nothing, for tests of the job system", jobs::ValidateSelftest,
       jobs::MakeSelftestRunner},
      {"correct", "variants of clips that a simulated body has imitated", ValidateCorrect,
       MakeCorrectRunner},
      {"train_vae", "a variational autoencoder of one class's motions", ValidateTrainVae, nullptr},
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

}  // namespace poise::engine
