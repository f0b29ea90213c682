#ifndef POISE_CORE_RUNTIME_JOBS_JOB_RUNNER_H_
#define POISE_CORE_RUNTIME_JOBS_JOB_RUNNER_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/time/time.h"
#include "core/api/job.h"
#include "core/base/json.h"
#include "core/base/run_context.h"
#include "core/base/status.h"

namespace poise::jobs {

/// One attempt at a job, as its own process sees it.
struct RunInput {
  std::string job;  ///< id
  int attempt = 1;
  api::JobSpec spec;
  uint64_t seed = 0;
  std::string trace_id;
  std::filesystem::path folder;  ///< empty at the start; goes away after the attempt
  /// Files with the bytes of the artifacts that the parameters name, by "artifacts/<sha256>".
  std::map<std::string, std::filesystem::path> inputs;
  /// Bytes given to SaveCheckpoint by an earlier attempt, with their step.
  std::optional<std::string> checkpoint;
  int64_t checkpoint_step = 0;
};

/// A file of the result, written below RunInput::folder.
struct OutputFile {
  std::string name;  ///< path within the result: "variants/0001.bvh"
  std::filesystem::path path;
  std::string media_type = "application/octet-stream";
};

struct RunOutput {
  std::vector<OutputFile> files;
  base::Json report;  ///< for the manifest: scores and the like; null when there is none
};

/// Seed, progress, cancellation and deadline of an attempt, and the way to its checkpoints.
/// A wish to stop (cancel, or drain: the worker goes away and another goes on) arrives as
/// cancellation: save a checkpoint, then return run.Check().
struct JobContext {
  base::RunContext run;
  absl::Duration checkpoint_interval = absl::Seconds(10);
  /// Hands `bytes` over as the state after `step`; returns before they are durable.
  std::function<Status(std::string_view bytes, int64_t step)> save_checkpoint;
};

/// Runs one kind of job, or wraps another runner (log, counters, deadline, manifest).
/// Same input, same seed, same kind of machine: same files, however often it was interrupted.
class JobRunner {
 public:
  virtual ~JobRunner() = default;
  virtual StatusOr<RunOutput> Run(const RunInput& input, const JobContext& context) = 0;
};

}  // namespace poise::jobs

#endif  // POISE_CORE_RUNTIME_JOBS_JOB_RUNNER_H_
