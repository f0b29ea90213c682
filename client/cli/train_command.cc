#include <fmt/format.h>

#include <memory>
#include <utility>

#include "client/cli/benchmark_form_flags.h"
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
constexpr char kPredictorDescription[] =
    "Train a network that says what comes next in a motion.\n\n"
    "It learns from all clips of the class but those of the actor of --hold-out; which weights are "
    "kept is decided on the ends of long training clips. Clips are brought to --rate and, with "
    "--body "
    "roles, to the 16 joints of the required roles. Settings: preset recommended or that of a "
    "published network, then --set.";
constexpr char kPredictorFooter[] =
    "Examples:\n"
    "  poise train predictor --data hdm05 --class kick --hold-out tr --name kick-next\n"
    "  poise train predictor --data cmu --body all --rate 60 --name mine --set trainer.steps=8000\n"
    "  poise predict kick.amc --model kick-next";
constexpr char kPushDescription[] =
    "Train networks that forecast what people do after a push, on recorded takes.\n\n"
    "The takes are read from the folder of FZJ Push and kept on the server. The published test "
    "takes are not learned from and choose nothing. Settings: preset recommended, or paper for the "
    "paper's own method, then --set.";
constexpr char kPushFooter[] =
    "Examples:\n"
    "  poise train push --data ~/fzj_push --name push-mine --seed 1\n"
    "  poise train push --data ~/fzj_push --name push-a --set protocol=A --detach";
constexpr char kDebiasDescription[] =
    "Train the network that undoes what imitation changes about the motions of one class.\n\n"
    "A simulated body imitates every clip; the network learns the way back, frame by frame, and "
    "poise correct --debias applies it. The actor of --hold-out is not learned from; how near to "
    "the originals his motions are before and after stands in the model's card. Settings: preset "
    "recommended or paper, then --set (effort, correction: which imitation).";
constexpr char kDebiasFooter[] =
    "Examples:\n"
    "  poise train debias --data hdm05 --class kick --hold-out tr --name kick-habits --seed 1\n"
    "  poise train debias --data hdm05 --class kick --name kick-habits --set effort=fast";
constexpr const char* kModelFile = "model.safetensors";

struct TrainOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string kind;  // of the job
  std::string data, license, name, action_class, hold_out;
  base::Json more = base::Json::object();  // parameters of this kind alone
  std::string preset = "recommended";
  std::vector<std::string> assignments;  // of --set
  uint64_t seed = 0;
  std::string request_id;
  bool detach = false;
};

StatusOr<api::CreateJob> Request(const TrainOptions& options, const api::DataSet& data) {
  api::CreateJob request;
  request.spec.kind = options.kind;
  request.request_id = options.request_id;
  request.seed = options.seed;
  POISE_ASSIGN_OR_RETURN(const auto settings, ParsePairs(options.assignments, "set"));
  request.spec.parameters = {{"name", options.name},     {"data_artifact", data.artifact},
                             {"data", data.name},        {"data_license", data.license},
                             {"preset", options.preset}, {"set", settings}};
  request.spec.parameters.update(options.more);
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
Status Train(const TrainOptions& options, client::Client& client, const api::DataSet& data,
             JobWait& wait, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const api::CreateJob request, Request(options, data));
  POISE_ASSIGN_OR_RETURN(api::Job job, client.CreateJob(request));
  if (options.detach) return wait.Answer(client, std::move(job));
  POISE_ASSIGN_OR_RETURN(job, wait.End(client, std::move(job)));
  if (job.state != api::JobState::kSucceeded) return wait.Report(job);
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

// On a registered data set.
Status TrainOnClips(TrainOptions options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::DataSet data, client->GetDataSet(options.data));
  options.more["action_class"] = options.action_class;
  options.more["hold_out"] = options.hold_out;
  return Train(options, *client, data, wait, console);
}

// On a folder of recordings, which travels as one file.
Status TrainOnTakes(const TrainOptions& options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  api::DataSet data;
  data.name = "FZJ Push";
  data.license = options.license;
  POISE_ASSIGN_OR_RETURN(data.artifact, UploadTakes(*client, options.data, console));
  return Train(options, *client, data, wait, console);
}

void AddTrainingFlags(CLI::App& command, TrainOptions& options) {
  command.add_option("--name", options.name, "Name of the model; this is its next version")
      ->type_name("NAME")
      ->required();
  command.add_option("--preset", options.preset, "recommended, or as published")
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

void AddClipFlags(CLI::App& command, TrainOptions& options) {
  command.add_option("--data", options.data, "Data set (poise data list)")
      ->type_name("NAME")
      ->required();
  command.add_option("--class", options.action_class, "Class of the clips: kick, jog, ...")
      ->type_name("CLASS");
  command.add_option("--hold-out", options.hold_out, "Actor who is not learned from")
      ->type_name("ACTOR");
  AddTrainingFlags(command, options);
}

// A training that the clips and its settings say all about.
Command AddOnClips(CLI::App& train, const Console& console, const char* name, const char* kind,
                   const char* description, const char* footer) {
  auto options = std::make_shared<TrainOptions>();
  options->kind = kind;
  CLI::App* command = train.add_subcommand(name, description);
  command->footer(footer);
  AddClipFlags(*command, *options);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return TrainOnClips(*options, console); }};
}

Command AddPredictor(CLI::App& train, const Console& console) {
  auto options = std::make_shared<TrainOptions>();
  auto form = std::make_shared<motion::BenchmarkForm>();
  options->kind = "train_predictor";
  CLI::App* command = train.add_subcommand("predictor", kPredictorDescription);
  command->footer(kPredictorFooter);
  AddClipFlags(*command, *options);
  AddBenchmarkFormFlags(*command, *form);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, form, &console] {
            options->more = base::FieldsToJson(form->Fields());
            return TrainOnClips(*options, console);
          }};
}

Command AddPush(CLI::App& train, const Console& console) {
  auto options = std::make_shared<TrainOptions>();
  options->kind = "train_push";
  CLI::App* command = train.add_subcommand("push", kPushDescription);
  command->footer(kPushFooter);
  command->add_option("--data", options->data, "Folder of FZJ Push")->type_name("DIR")->required();
  command->add_option("--license", options->license, "Of the data, for the model's card")
      ->type_name("TEXT");
  AddTrainingFlags(*command, *options);
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return TrainOnTakes(*options, console); }};
}

}  // namespace

std::vector<Command> AddTrainCommands(CLI::App& app, const Console& console) {
  CLI::App* train = app.add_subcommand("train", kDescription);
  train->footer("Example:\n  poise train vae --data hdm05 --class kick --name kick");
  return {AddOnClips(*train, console, "vae", "train_vae", kVaeDescription, kVaeFooter),
          AddOnClips(*train, console, "debias", "train_debias", kDebiasDescription, kDebiasFooter),
          AddPredictor(*train, console), AddPush(*train, console)};
}

}  // namespace poise::cli
