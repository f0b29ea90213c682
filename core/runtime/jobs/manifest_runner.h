#ifndef POISE_CORE_RUNTIME_JOBS_MANIFEST_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_MANIFEST_RUNNER_H_

#include <memory>

#include "core/runtime/jobs/job_runner.h"

namespace poise::jobs {

/// The name of the file that ManifestRunner adds.
inline constexpr char kManifestName[] = "manifest.json";

/// Adds a file that says where a result comes from and what belongs to it: kind, parameters, seed,
/// a hash of these three, the program's version, name, size and SHA-256 of every file, sorted by
/// name, and what the runner reports. It knows no time and no attempt, so a job that was
/// interrupted has the same manifest. Errors: kInternal BAD_OUTPUT when a file has a name twice,
/// the manifest's name or one that leaves the result, or cannot be read.
class ManifestRunner : public JobRunner {
 public:
  explicit ManifestRunner(std::unique_ptr<JobRunner> inner) : inner_(std::move(inner)) {}

  StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) override;

 private:
  const std::unique_ptr<JobRunner> inner_;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_MANIFEST_RUNNER_H_
