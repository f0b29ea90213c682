#include <fmt/format.h>

#include <memory>
#include <utility>

#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_wait.h"
#include "client/cli/push_takes.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Train a network on a server.\n\n"
    "The training is a job: it survives whatever is killed and goes on from its last checkpoint. "
    "When it ends the server gives the model its name. The command waits for that; with --detach "
    "it "
    "prints the job and ends.";
constexpr char kVaeDescription[] =
    "Train MotionAug's variational autoencoder on the clips of one class.\n\n"
    "The actor of --hold-out is not learned from; how well his motions are reconstructed stands in "
    "the model's card. Settings: preset recommended or paper, then --set.";
constexpr char kVaeFooter[] =
    "Examples:\n"
    "  poise train vae --data hdm05 --class kick --hold-out tr --name kick-tr --seed 1\n"
    "  poise train vae --data hdm05 --class jog --name jog --preset paper --detach\n"
    "  poise train vae --data hdm05 --class kick --name kick --set trainer.steps=500";
constexpr char kPushDescription[] =
    "Train networks that forecast what people do after a push, on recorded takes.\n\n"
    "The takes are read from the folder of FZJ Push and kept on the server. The published test "
    "takes are not learned from and choose nothing. Settings: preset recommended, then --set.";
constexpr char kPushFooter[] =
    "Examples:\n"
    "  poise train push --data ~/fzj_push --name push-mine --seed 1\n"
    "  poise train push --data ~/fzj_push --name push-a --set protocol=A --detach";
constexpr const char* kModelFile = "model.safetensors";

struct TrainOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string data, license, name, action_class, hold_out;
  std::string preset = "recommended";
  std::vector<std::string> assignments;  // of --set
  uint64_t seed = 0;
  std::string request_id;
  bool detach = false;
};

// What is learned from; `parameters` are those of the kind of job alone.
StatusOr<api::CreateJob> Request(const TrainOptions& options, const std::string& kind,
                                 const std::string& artifact, const std::string& license,
                                 base::Json parameters) {
  api::CreateJob request;
  request.spec.kind = kind;
  request.request_id = options.request_id;
  request.seed = options.seed;
  POISE_ASSIGN_OR_RETURN(const auto settings, ParsePairs(options.assignments, "set"));
  parameters["name"] = options.name;
  parameters["data_artifact"] = artifact;
  parameters["data_license"] = license;
  parameters["preset"] = options.preset;
  parameters["set"] = settings;
  request.spec.parameters = std::move(parameters);
  return request;
}

StatusOr<std::string> ModelArtifact(const api::Job& job) {
  for (const api::JobArtifact& file : job.artifacts) {
    if (file.name == kModelFile) return file.artifact;
  }
  return base::NotFound("ARTIFACT_NOT_FOUND", "",
                        fmt::format("jobs/{} has no {}", job.id, kModelFile));
}

// Makes the job and shows what came of it.
Status Train(const TrainOptions& options, JobWait& wait, client::Client& client,
             const api::CreateJob& request, const Console& console) {
  POISE_ASSIGN_OR_RETURN(api::Job job, client.CreateJob(request));
  if (options.detach) return wait.Answer(client, std::move(job));
  POISE_ASSIGN_OR_RETURN(job, wait.End(client, std::move(job)));
  if (job.state != api::JobState::kSucceeded) return JobOutcome(job);
  POISE_ASSIGN_OR_RETURN(const std::string artifact, ModelArtifact(job));
  // The server has done so; the answer is which version it became.
  POISE_ASSIGN_OR_RETURN(const api::Model model, client.ImportModel(options.name, artifact));
  if (console.json()) {
    console.PrintJson({{"model", model.name},
                       {"version", model.version},
                       {"job", "jobs/" + job.id},
                       {"card", api::ToJson(model.card)},
                       {"scores", model.card.scores}});
    return absl::OkStatus();
  }
  console.Print(fmt::format("{}@{}, {}", model.name, model.version, model.card.trained_on));
  for (const auto& [name, value] : model.card.scores) {
    console.Print(fmt::format("  {:<28} {:.4f}", name, value));
  }
  return absl::OkStatus();
}

Status RunVae(const TrainOptions& options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::DataSet data, client->GetDataSet(options.data));
  POISE_ASSIGN_OR_RETURN(const api::CreateJob request,
                         Request(options, "train_vae", data.artifact, data.license,
                                 {{"data", data.name},
                                  {"action_class", options.action_class},
                                  {"hold_out", options.hold_out}}));
  return Train(options, wait, *client, request, console);
}

Status RunPush(const TrainOptions& options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const std::string artifact, UploadTakes(*client, options.data, console));
  POISE_ASSIGN_OR_RETURN(
      const api::CreateJob request,
      Request(options, "train_push", artifact, options.license, {{"data", "FZJ Push"}}));
  return Train(options, wait, *client, request, console);
}

void AddTrainingFlags(CLI::App& command, TrainOptions& options) {
  command.add_option("--name", options.name, "Name of the model; this is its next version")
      ->type_name("NAME")
      ->required();
  command.add_option("--preset", options.preset, "Named settings")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--set", options.assignments, "A setting; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--seed", options.seed, "Seed of all random choices")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--request-id", options.request_id, "The same id again is the same job")
      ->type_name("ID");
  command.add_flag("--detach", options.detach, "Print the job and do not wait");
}

Command AddTrainVaeCommand(CLI::App& train, const Console& console) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App& command = *train.add_subcommand("vae", kVaeDescription);
  command.footer(kVaeFooter);
  command.add_option("--data", options->data, "Data set (poise data list)")
      ->type_name("NAME")
      ->required();
  command.add_option("--class", options->action_class, "Class of the clips: kick, jog, ...")
      ->type_name("CLASS");
  command.add_option("--hold-out", options->hold_out, "Actor who is not learned from")
      ->type_name("ACTOR");
  AddTrainingFlags(command, *options);
  AddConnectionFlags(command, options->connection);
  return {&command, [options, &console] { return RunVae(*options, console); }};
}

Command AddTrainPushCommand(CLI::App& train, const Console& console) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App& command = *train.add_subcommand("push", kPushDescription);
  command.footer(kPushFooter);
  command.add_option("--data", options->data, "Folder of FZJ Push")->type_name("DIR")->required();
  command.add_option("--license", options->license, "Of the data, for the model's card")
      ->type_name("TEXT");
  AddTrainingFlags(command, *options);
  AddConnectionFlags(command, options->connection);
  return {&command, [options, &console] { return RunPush(*options, console); }};
}

}  // namespace

std::vector<Command> AddTrainCommands(CLI::App& app, const Console& console) {
  CLI::App* train = app.add_subcommand("train", kDescription);
  train->footer("Example:\n  poise train vae --data hdm05 --class kick --name kick");
  return {AddTrainVaeCommand(*train, console), AddTrainPushCommand(*train, console)};
}

}  // namespace poise::cli
