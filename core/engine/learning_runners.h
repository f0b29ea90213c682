#ifndef POISE_CORE_ENGINE_LEARNING_RUNNERS_H_
#define POISE_CORE_ENGINE_LEARNING_RUNNERS_H_

#include <memory>
#include <string_view>

#include "core/runtime/jobs/job_runner.h"

namespace poise::engine {

/// The runner of a kind, able to do what needs LibTorch (the flow table, which server and worker
/// read, knows that by name only). For poise-learner. Errors: those of FindFlow.
StatusOr<std::unique_ptr<jobs::JobRunner>> MakeRunner(std::string_view kind);

}  // namespace poise::engine

#endif  // POISE_CORE_ENGINE_LEARNING_RUNNERS_H_
