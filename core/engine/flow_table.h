#ifndef POISE_CORE_ENGINE_FLOW_TABLE_H_
#define POISE_CORE_ENGINE_FLOW_TABLE_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/api/job.h"
#include "core/base/json.h"
#include "core/base/status.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

inline constexpr std::string_view kModelFile = "model.safetensors";

/// One kind of job: what server and worker must agree on.
struct Flow {
  std::string_view kind;
  std::string_view summary;  ///< for people
  /// Errors: kInvalidArgument with a field below "spec.parameters".
  Status (*validate)(const base::Json& parameters);
  /// Without LibTorch. Null where no job of the kind can do without: learning_runners.h.
  std::unique_ptr<jobs::JobRunner> (*make_runner)();
  /// Which jobs cannot do without LibTorch; null: none, or all where make_runner is null.
  bool (*needs_torch)(const base::Json& parameters) = nullptr;
  /// Its result holds kModelFile, which becomes the next version of the model that the parameter
  /// "name" names, if it does.
  bool trains = false;
};

/// Every kind that this build knows: a new one is a line here.
const std::vector<Flow>& FlowTable();

/// Errors: kInvalidArgument UNKNOWN_JOB_KIND, with the kinds there are.
StatusOr<const Flow*> FindFlow(std::string_view kind);

/// The runner of a kind for a job that needs no LibTorch. Errors: those of FindFlow;
/// kFailedPrecondition NO_NETWORKS.
StatusOr<std::unique_ptr<jobs::JobRunner>> MakeLightRunner(std::string_view kind);

/// Whether the process of a job must load LibTorch. False for an unknown kind.
bool NeedsTorch(const api::JobSpec& spec);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_FLOW_TABLE_H_
