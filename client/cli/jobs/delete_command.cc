#include <fmt/format.h>

#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/client.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Remove jobs that have ended, with their results.\n\n"
    "The server does this by itself when they expire (jobs get says when). A job that has not "
    "ended must be cancelled first.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs delete jobs/019abc\n"
    "  poise jobs delete $(poise jobs list --state FAILED --json | jq -r .name)";

struct DeleteOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::vector<std::string> names;
};

Status RunDelete(const DeleteOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> ids, ParseJobNames(options.names));
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  for (const std::string& id : ids) {
    POISE_RETURN_IF_ERROR(client->DeleteJob(id));
    if (console.json()) {
      console.PrintJson({{"name", convert::JobName(id)}, {"deleted", true}});
    } else {
      console.Print(fmt::format("{} deleted", convert::JobName(id)));
    }
  }
  return absl::OkStatus();
}

}  // namespace

Command AddJobsDeleteCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<DeleteOptions>();
  CLI::App* command = jobs.add_subcommand("delete", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->names, "jobs/ID or ID, one or several")
      ->type_name("")
      ->required();
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunDelete(*options, console); }};
}

}  // namespace poise::cli
