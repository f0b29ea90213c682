#ifndef POISE_SERVER_WORKER_WORKER_CONFIG_H_
#define POISE_SERVER_WORKER_WORKER_CONFIG_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/client_options.h"
#include "core/runtime/jobs/job_store.h"

namespace poise::worker {

/// How one worker works.
struct WorkerConfig {
  client::ClientOptions client;
  jobs::WorkerInfo info;                         ///< id: never used before
  std::vector<std::string> queues;               ///< empty: all
  std::vector<std::string> kinds;                ///< that it takes
  std::filesystem::path work_dir;                ///< attempts write below <work_dir>/<id>
  std::string child_program = "/proc/self/exe";  ///< called with --child
  std::string learner_program;                   ///< the same for jobs that need LibTorch

  absl::Duration idle_exit = absl::InfiniteDuration();  ///< without a job for this long it ends
  absl::Duration max_time = absl::InfiniteDuration();   ///< after this it drains
  absl::Duration lease_wait = absl::Seconds(20);        ///< of the long poll for a job

  absl::Duration drain = absl::Seconds(30);  ///< after which a drain becomes a hurry
  /// While draining: between SIGTERM and SIGKILL for a child, if that is more than the job's
  /// cancel_grace. Saving the state of a large model takes its time.
  absl::Duration drain_grace = absl::Seconds(10);
  absl::Duration hurry = absl::Seconds(5);  ///< after which the process ends, whatever it does

  absl::Duration checkpoint_interval = absl::Seconds(10);  ///< told to those that save by time
  /// At the end of an attempt that did not succeed: for the checkpoint that is on its way.
  absl::Duration flush_limit = absl::Seconds(10);
  /// For the files of a result while the server has no room for them.
  absl::Duration upload_limit = absl::Minutes(5);
};

}  // namespace poise::worker

#endif  // POISE_SERVER_WORKER_WORKER_CONFIG_H_
