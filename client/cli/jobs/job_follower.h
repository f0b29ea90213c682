#ifndef POISE_CLIENT_CLI_JOBS_JOB_FOLLOWER_H_
#define POISE_CLIENT_CLI_JOBS_JOB_FOLLOWER_H_

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/cli/console.h"
#include "client/cli/interrupt.h"
#include "client/cli/jobs/live_lines.h"
#include "client/client.h"

namespace poise::cli {

/// Follows jobs to their ends and shows them meanwhile: on a terminal a line each that is redrawn,
/// elsewhere a line for every change of state and every tenth of the way, with --json a line for
/// every event. Ctrl-C ends it and leaves the jobs alone. Make it before the client: its
/// InterruptHandler must come before other threads.
class JobFollower {
 public:
  /// kQuiet: only on a terminal; for commands that print the job itself at the end.
  enum class Style { kEvents, kQuiet };
  JobFollower(const Console& console, Style style);

  /// Returns when all have ended, however. Errors: kCancelled INTERRUPTED, which says how to cancel
  /// the jobs; kDeadlineExceeded; those of JobWatch.
  Status Follow(client::Client& client, const std::vector<std::string>& ids, absl::Time deadline);

 private:
  struct Followed {
    std::string id;
    std::unique_ptr<client::JobWatch> watch;
    api::Job job;
    int64_t tenth = 0;  // of the progress that was last printed
    Status status;
  };

  void Run(Followed& followed);
  void Show(Followed& followed, const api::JobEvent& event);  // with mutex_ held
  void PrintChange(Followed& followed, const api::JobEvent& event);
  std::string Text() const;
  void Stop();

  const Console& console_;
  const Style style_;
  std::mutex mutex_;
  std::vector<Followed> jobs_;
  bool stopped_ = false;
  std::unique_ptr<LiveLines> live_;
  InterruptHandler interrupt_;
};

/// The end of a job, as the end of the command that waited for it: OK when it SUCCEEDED, else
/// JOB_FAILED or JOB_CANCELLED (exit_code.h).
Status JobOutcome(const api::Job& job);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_JOB_FOLLOWER_H_
