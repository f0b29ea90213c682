#ifndef POISE_CORE_RUNTIME_JOBS_SELFTEST_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_SELFTEST_RUNNER_H_

#include <memory>

#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// Runs SelftestConfig. Its state is a chain of hashes that begins with the seed, and its files are
/// drawn from the last one: a step left out or done twice after a restart changes every byte.
/// Errors: those that were asked for; kDataLoss CORRUPT_CHECKPOINT.
class SelftestRunner : public JobRunner {
 public:
  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;
};

/// For the flow table.
std::unique_ptr<JobRunner> MakeSelftestRunner();

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_SELFTEST_RUNNER_H_
