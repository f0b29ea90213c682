#ifndef POISE_TESTS_CORE_RUNTIME_JOBS_ATTEMPT_FOLDER_H_
#define POISE_TESTS_CORE_RUNTIME_JOBS_ATTEMPT_FOLDER_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/runtime/jobs/job_runner.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {

/// Runs attempts at one job, each in an empty folder, and records what they hand over.
class AttemptFolder {
 public:
  explicit AttemptFolder(const base::Json& parameters, uint64_t seed = 7);

  /// The next attempt; goes on from the last checkpoint.
  StatusOr<jobs::RunOutput> Run(jobs::JobRunner& runner);
  /// Contents of the files of a result, by name.
  static std::map<std::string, std::string> Contents(const jobs::RunOutput& output);

  jobs::RunInput input;
  jobs::JobContext context;
  std::vector<base::Progress> progress;
  std::vector<int64_t> checkpoint_steps;
  /// Called with each progress, on the runner's thread.
  std::function<void(const base::Progress&)> on_progress;

 private:
  TemporaryFolder folder_;
};

}  // namespace poise::testing

#endif  // POISE_TESTS_CORE_RUNTIME_JOBS_ATTEMPT_FOLDER_H_
