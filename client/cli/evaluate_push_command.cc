#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_wait.h"
#include "client/cli/push_takes.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Score push forecasts on recorded takes, on a server.\n\n"
    "The published test takes of FZJ Push are forecast by the model, told of the push what its "
    "card "
    "says, and beside it by what needs no learning: nobody moves, a statue on the true hip, a "
    "statue "
    "on our own pendulum. The file has a row for each take, the means, and the means without the "
    "two "
    "outlier takes. A job does it; with --detach its files are fetched by poise jobs result.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise evaluate push --data ~/fzj_push --model push-mine --out scores.csv\n"
    "  poise evaluate push --data ~/fzj_push --out anchors.csv";
constexpr const char* kScoresFile = "scores.csv";

struct EvaluatePushOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string data, model;
  std::string out = kScoresFile;
  uint64_t seed = 1;
  bool detach = false;
};

StatusOr<api::CreateJob> Request(const EvaluatePushOptions& options, client::Client& client,
                                 const Console& console) {
  api::CreateJob request;
  request.spec.kind = "evaluate_push";
  request.seed = options.seed;
  if (!options.model.empty()) {
    POISE_ASSIGN_OR_RETURN(const client::StoredArtifact model, client.ExportModel(options.model));
    request.spec.parameters["model_artifact"] = model.name;
    request.spec.parameters["model"] = options.model;
  }
  POISE_ASSIGN_OR_RETURN(const std::string takes, UploadTakes(client, options.data, console));
  request.spec.parameters["data_artifact"] = takes;
  return request;
}

Status Run(const EvaluatePushOptions& options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::CreateJob request, Request(options, *client, console));
  POISE_ASSIGN_OR_RETURN(api::Job job, client->CreateJob(request));
  if (options.detach) return wait.Answer(*client, std::move(job));
  POISE_ASSIGN_OR_RETURN(job, wait.End(*client, std::move(job)));
  if (job.state != api::JobState::kSucceeded) return JobOutcome(job);
  for (const api::JobArtifact& file : job.artifacts) {
    if (file.name != kScoresFile) continue;
    POISE_RETURN_IF_ERROR(client->DownloadFile(file.artifact, options.out));
    if (console.json()) {
      console.PrintJson({{"job", "jobs/" + job.id}, {"file", options.out}});
    } else {
      console.Print(options.out);
    }
    return absl::OkStatus();
  }
  return base::NotFound("ARTIFACT_NOT_FOUND", "",
                        fmt::format("jobs/{} has no {}", job.id, kScoresFile));
}

}  // namespace

Command AddEvaluatePushCommand(CLI::App& evaluate, const Console& console) {
  auto options = std::make_shared<EvaluatePushOptions>();
  CLI::App* command = evaluate.add_subcommand("push", kDescription);
  command->footer(kFooter);
  command->add_option("--data", options->data, "Folder of FZJ Push")->type_name("DIR")->required();
  command
      ->add_option("--model", options->model, "A trained model; else only what needs no learning")
      ->type_name("NAME");
  command->add_option("--out", options->out, "Results file")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of noise and of the bootstrap")
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--detach", options->detach, "Print the job and do not wait");
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return Run(*options, console); }};
}

}  // namespace poise::cli
