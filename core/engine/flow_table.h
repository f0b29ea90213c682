#ifndef POISE_CORE_ENGINE_FLOW_TABLE_H_
#define POISE_CORE_ENGINE_FLOW_TABLE_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "core/base/status.h"
#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// One kind of job: what server and worker must agree on.
struct Flow {
  std::string_view kind;
  std::string_view summary;  ///< for people
  /// Errors: kInvalidArgument with a field below "spec.parameters".
  Status (*validate)(const base::Json& parameters);
  /// Null where the runner needs LibTorch, which the server need not load: learning_runners.h.
  std::unique_ptr<jobs::JobRunner> (*make_runner)();
};

/// Every kind that this build knows: a new one is a line here.
const std::vector<Flow>& FlowTable();

/// Errors: kInvalidArgument UNKNOWN_JOB_KIND, with the kinds there are.
StatusOr<const Flow*> FindFlow(std::string_view kind);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_FLOW_TABLE_H_
