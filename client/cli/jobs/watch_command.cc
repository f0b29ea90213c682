#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_follower.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Follow jobs until they have ended.\n\n"
    "On a terminal a line for each job is redrawn; elsewhere a line tells every change of state "
    "and every tenth of the way; with --json every event is a line. A server that restarts "
    "meanwhile is waited for, and no change is lost. Ctrl-C stops watching, not the jobs.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs watch jobs/019abc\n"
    "  poise jobs watch $(poise jobs list --state RUNNING --json | jq -r .name)\n"
    "  poise jobs watch 019abc --json | jq 'select(.progress) | .progress.step'\n\n"
    "Exit code: 0 all SUCCEEDED, 8 one FAILED, 6 one was CANCELLED, Ctrl-C or out of time.";

struct WatchFlags {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::vector<std::string> names;
  double timeout_s = 0;
};

Status RunWatch(const WatchFlags& options, const Console& console) {
  const absl::Time deadline = DeadlineAfter(options.timeout_s);
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> ids, ParseJobNames(options.names));
  JobFollower follower(console, JobFollower::Style::kEvents);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_RETURN_IF_ERROR(follower.Follow(*client, ids, deadline));
  Status outcome;
  for (const std::string& id : ids) {
    POISE_ASSIGN_OR_RETURN(const api::Job job, client->GetJob(id));
    if (!console.json() && Console::HasTerminal()) console.Print(JobLine(job));
    const Status ended = JobOutcome(job);
    // A failure counts more than a wish.
    if (outcome.ok() || job.state == api::JobState::kFailed) outcome = ended;
  }
  return outcome;
}

}  // namespace

Command AddJobsWatchCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<WatchFlags>();
  CLI::App* command = jobs.add_subcommand("watch", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->names, "jobs/ID or ID, one or several")
      ->type_name("")
      ->required();
  command->add_option("--timeout", options->timeout_s, "Give up after this long")
      ->type_name("SECONDS");
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunWatch(*options, console); }};
}

}  // namespace poise::cli
