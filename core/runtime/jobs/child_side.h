#ifndef POISE_CORE_RUNTIME_JOBS_CHILD_SIDE_H_
#define POISE_CORE_RUNTIME_JOBS_CHILD_SIDE_H_

#include <functional>
#include <memory>
#include <string_view>

#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// Makes the runner of a kind.
using RunnerFactory = std::function<StatusOr<std::unique_ptr<JobRunner>>(std::string_view kind)>;

/// What a program does as the child of ChildProcessRunner: takes one attempt from descriptor 3,
/// runs it, tells progress, checkpoints and the result there. SIGTERM is the wish to stop. An
/// exception ends the attempt with kInternal UNCAUGHT_EXCEPTION, std::bad_alloc with
/// kResourceExhausted OUT_OF_MEMORY. Returns the exit code; to be called once, from main.
int ServeChild(const RunnerFactory& make_runner);

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_CHILD_SIDE_H_
