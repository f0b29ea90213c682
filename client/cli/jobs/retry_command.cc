#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_wait.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Run a FAILED or CANCELLED job again.\n\n"
    "A job that has ended never changes: this makes a new one from its parameters and its last "
    "checkpoint, and prints its name.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs retry jobs/019abc --wait\n"
    "  poise jobs retry 019abc --request-id night-7b --json";

struct RetryOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string name;
  std::string request_id;
  WaitFlags wait;
};

Status RunRetry(const RetryOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::string id, ParseJobName(options.name));
  JobWait wait(options.wait, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(api::Job job, client->RetryJob(id, options.request_id));
  return wait.Answer(*client, std::move(job));
}

}  // namespace

Command AddJobsRetryCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<RetryOptions>();
  CLI::App* command = jobs.add_subcommand("retry", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->name, "jobs/ID or ID")->type_name("")->required();
  command
      ->add_option("--request-id", options->request_id,
                   "The same id again is the same job; default: one of its own")
      ->type_name("ID");
  AddWaitFlags(*command, options->wait);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunRetry(*options, console); }};
}

}  // namespace poise::cli
