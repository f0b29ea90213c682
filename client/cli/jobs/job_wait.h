#ifndef POISE_CLIENT_CLI_JOBS_JOB_WAIT_H_
#define POISE_CLIENT_CLI_JOBS_JOB_WAIT_H_

#include <optional>

#include "client/cli/command_line.h"
#include "client/cli/console.h"
#include "client/cli/jobs/job_follower.h"
#include "client/client.h"

namespace poise::cli {

/// --wait and --timeout.
struct WaitFlags {
  bool wait = false;
  double timeout_s = 0;
};
void AddWaitFlags(CLI::App& command, WaitFlags& flags);

/// The end of a command that made a job or asked something of one: with --wait it stays until the
/// job has ended. Make it before the client, as JobFollower.
class JobWait {
 public:
  JobWait(const WaitFlags& flags, const Console& console);

  /// The job at its end; without --wait as it is. Errors: those of JobFollower.
  StatusOr<api::Job> End(client::Client& client, api::Job job);

  /// Ends the command with the job that it made: its name, or with --wait its end, as JobOutcome.
  Status Answer(client::Client& client, api::Job job);
  /// Ends a command that waited for a job with that job at its end: why it failed.
  Status Report(const api::Job& job) const;

 private:
  const Console& console_;
  const absl::Time deadline_;
  std::optional<JobFollower> follower_;  // with --wait
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_JOBS_JOB_WAIT_H_
