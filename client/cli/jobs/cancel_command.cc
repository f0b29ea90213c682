#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_json.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "client/cli/jobs/job_wait.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Ask jobs to stop.\n\n"
    "One that waits is CANCELLED at once. One that runs is CANCELLING until its process is gone, "
    "about a second later; --wait stays for that. A job that had already ended stays as it is, "
    "which is no error.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs cancel jobs/019abc --wait\n"
    "  poise jobs cancel $(poise jobs list --state QUEUED --json | jq -r .name)";

struct CancelOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::vector<std::string> names;
  WaitFlags wait;
};

Status RunCancel(const CancelOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> ids, ParseJobNames(options.names));
  JobWait wait(options.wait, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  std::vector<api::Job> jobs;
  for (const std::string& id : ids) {
    POISE_ASSIGN_OR_RETURN(api::Job job, client->CancelJob(id));
    jobs.push_back(std::move(job));
  }
  for (api::Job& job : jobs) {
    POISE_ASSIGN_OR_RETURN(job, wait.End(*client, std::move(job)));
    if (console.json()) {
      console.PrintJson(JobJson(job));
    } else {
      console.Print(JobLine(job));
    }
  }
  return absl::OkStatus();
}

}  // namespace

Command AddJobsCancelCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<CancelOptions>();
  CLI::App* command = jobs.add_subcommand("cancel", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->names, "jobs/ID or ID, one or several")
      ->type_name("")
      ->required();
  AddWaitFlags(*command, options->wait);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunCancel(*options, console); }};
}

}  // namespace poise::cli
