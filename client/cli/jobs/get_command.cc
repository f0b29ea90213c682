#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_json.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_text.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Show everything about a job: state, progress, attempts, results.\n\n"
    "A job is named jobs/ID, or just ID.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs get jobs/019abc\n"
    "  poise jobs get 019abc --json | jq .state";

struct GetOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string name;
};

Status RunGet(const GetOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::string id, ParseJobName(options.name));
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::Job job, client->GetJob(id));
  if (console.json()) {
    console.PrintJson(JobJson(job));
  } else {
    console.Print(JobDetails(job));
  }
  return absl::OkStatus();
}

}  // namespace

Command AddJobsGetCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<GetOptions>();
  CLI::App* command = jobs.add_subcommand("get", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->name, "jobs/ID or ID")->type_name("")->required();
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunGet(*options, console); }};
}

}  // namespace poise::cli
