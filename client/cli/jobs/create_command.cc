#include <fmt/format.h>

#include <memory>

#include "client/cli/file_access.h"
#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_wait.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Give a server long work.\n\n"
    "Prints the job's name as soon as the server has it on disk; from then on the work survives "
    "whatever is killed. With --wait the command stays until the job has ended. A script that may "
    "be run twice gives a --request-id: the same id is the same job.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs create selftest --param steps=100 --param step_ms=50 --wait\n"
    "  poise jobs create selftest --request-id night-7 --label run=7 --json\n"
    "  poise jobs create selftest --params-file parameters.json --max-errors 1 --priority 5\n\n"
    "Exit code with --wait: 0 SUCCEEDED, 8 FAILED, 6 CANCELLED or out of time.";

struct CreateOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  api::CreateJob request;
  std::vector<std::string> parameters;
  std::string parameters_file;
  std::vector<std::string> labels;
  double deadline_s = 0;
  double stall_timeout_s = 0;
  double cancel_grace_s = -1;
  WaitFlags wait;
};

// Numbers, true, false, null, arrays and objects are what they look like; the rest is text.
base::Json ParameterValue(const std::string& text) {
  const auto json = base::ParseJson(text, "value");
  return json.ok() ? *json : base::Json(text);
}

StatusOr<base::Json> ReadParameters(const CreateOptions& options) {
  base::Json parameters = base::Json::object();
  if (!options.parameters_file.empty()) {
    POISE_ASSIGN_OR_RETURN(const std::string text, ReadFile(options.parameters_file));
    POISE_ASSIGN_OR_RETURN(parameters, base::ParseJson(text, options.parameters_file));
    if (!parameters.is_object()) {
      return base::InvalidArgument("BAD_USAGE", "params-file",
                                   fmt::format("{} holds no JSON object", options.parameters_file));
    }
  }
  POISE_ASSIGN_OR_RETURN(const auto pairs, ParsePairs(options.parameters, "param"));
  for (const auto& [key, value] : pairs) parameters[key] = ParameterValue(value);
  return parameters;
}

StatusOr<api::CreateJob> Request(const CreateOptions& options) {
  api::CreateJob request = options.request;
  POISE_ASSIGN_OR_RETURN(request.spec.parameters, ReadParameters(options));
  POISE_ASSIGN_OR_RETURN(request.labels, ParsePairs(options.labels, "label"));
  if (options.deadline_s > 0) request.limits.deadline = absl::Seconds(options.deadline_s);
  if (options.stall_timeout_s > 0) {
    request.limits.stall_timeout = absl::Seconds(options.stall_timeout_s);
  }
  if (options.cancel_grace_s >= 0) {
    request.limits.cancel_grace = absl::Seconds(options.cancel_grace_s);
  }
  return request;
}

Status RunCreate(const CreateOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const api::CreateJob request, Request(options));
  JobWait wait(options.wait, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(api::Job job, client->CreateJob(request));
  return wait.Answer(*client, std::move(job));
}

void AddRequestFlags(CLI::App& command, CreateOptions& options) {
  command.add_option("--param", options.parameters, "A parameter of the kind; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--params-file", options.parameters_file, "Parameters as a JSON object")
      ->type_name("FILE");
  command
      .add_option("--request-id", options.request.request_id,
                  "The same id again is the same job; default: one of its own")
      ->type_name("ID");
  command.add_option("--seed", options.request.seed, "Seed of all random choices")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--queue", options.request.queue, "Workers may serve some queues only")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--priority", options.request.priority, "-10 to 10, higher runs first")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--label", options.labels, "For lists; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void AddLimitFlags(CLI::App& command, CreateOptions& options) {
  constexpr char kGroup[] = "Limits";
  command
      .add_option("--max-errors", options.request.limits.max_errors,
                  "Attempts that may end with an error that a retry may cure")
      ->type_name("N")
      ->capture_default_str()
      ->group(kGroup);
  command
      .add_option("--max-losses", options.request.limits.max_losses,
                  "Workers that may be lost without progress")
      ->type_name("N")
      ->capture_default_str()
      ->group(kGroup);
  command.add_option("--deadline", options.deadline_s, "From creation to the end (default: none)")
      ->type_name("SECONDS")
      ->group(kGroup);
  command
      .add_option("--stall-timeout", options.stall_timeout_s,
                  "An attempt without a step for this long is stopped (default: 120)")
      ->type_name("SECONDS")
      ->group(kGroup);
  command
      .add_option("--cancel-grace", options.cancel_grace_s,
                  "Between asking an attempt to stop and killing it (default: 1)")
      ->type_name("SECONDS")
      ->group(kGroup);
}

}  // namespace

Command AddJobsCreateCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<CreateOptions>();
  CLI::App* command = jobs.add_subcommand("create", kDescription);
  command->footer(kFooter);
  command->add_option("KIND", options->request.spec.kind, "What to do: selftest or correct")
      ->type_name("")
      ->required();
  AddRequestFlags(*command, *options);
  AddLimitFlags(*command, *options);
  AddWaitFlags(*command, options->wait);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunCreate(*options, console); }};
}

}  // namespace poise::cli
