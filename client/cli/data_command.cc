#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <utility>

#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/table.h"
#include "client/client.h"
#include "core/motion/dataset/clip_folder.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Training data on a server: add, list, get, delete.\n\n"
    "A data set is a folder of motion files, read and checked once and kept under a name, so that "
    "workers anywhere can train on it. What is behind a name never changes; its fingerprint stands "
    "in the card of every model that learned from it.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise data add hdm05 ~/hdm05 --license \"CC BY-SA 3.0\"\n"
    "  poise data list\n"
    "  poise data delete hdm05";
constexpr char kAddDescription[] =
    "Read every motion file below a folder and keep the clips on the server.\n\n"
    "A file that cannot be read, or whose body lacks a role, is an error that names it. Actor and "
    "action come from names like HDM_bd_kickLFront1Reps_001_120.amc, else the action is the "
    "folder's name. Bodies stay as they are unless --retarget-to names a clip whose body all get.";
constexpr int kIndent = 2;

struct DataOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string name;
  std::string folder;
  motion::ClipFolderOptions read;
};
using Options = std::shared_ptr<DataOptions>;

void PrintDataSet(const api::DataSet& set, const Console& console) {
  if (console.json()) {
    console.PrintJson(api::ToJson(set));
  } else {
    console.Print(api::ToJson(set).dump(kIndent));
  }
}

Status RunAdd(const DataOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const motion::ClipSet set,
                         motion::ReadClipFolder(options.folder, options.read));
  console.Note(fmt::format("{} clips read", set.clips.size()));
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored,
                         client->Upload(motion::EncodeClipSet(set)));
  POISE_ASSIGN_OR_RETURN(const api::DataSet created,
                         client->CreateDataSet(options.name, stored.name));
  PrintDataSet(created, console);
  return absl::OkStatus();
}

Status RunList(const DataOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const std::vector<api::DataSet> sets, client->ListDataSets());
  Table table({"data set", "clips", "minutes", "actions", "actors", "license"});
  for (const api::DataSet& set : sets) {
    if (console.json()) console.PrintJson(api::ToJson(set));
    table.AddRow({set.name, fmt::format("{}", set.clips),
                  fmt::format("{:.1f}", set.duration_s / 60), fmt::format("{}", set.actions.size()),
                  fmt::format("{}", set.actors.size()), set.license});
  }
  if (!console.json()) console.Print(sets.empty() ? "no data sets" : table.Text());
  return absl::OkStatus();
}

Status RunGet(const DataOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::DataSet set, client->GetDataSet(options.name));
  PrintDataSet(set, console);
  return absl::OkStatus();
}

Status RunDelete(const DataOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_RETURN_IF_ERROR(client->DeleteDataSet(options.name));
  if (console.json()) {
    console.PrintJson({{"name", options.name}, {"deleted", true}});
  } else {
    console.Print(fmt::format("{} deleted", options.name));
  }
  return absl::OkStatus();
}

void AddReadFlags(CLI::App& command, DataOptions& options) {
  command.add_option("FOLDER", options.folder, "Folder of motion files")->type_name("")->required();
  command.add_option("--license", options.read.license, "What the data may be used for")
      ->type_name("TEXT");
  command.add_option("--class", options.read.action_class, "Of the action only: kick, jog, ...")
      ->type_name("CLASS");
  command.add_option("--retarget-to", options.read.retarget_to, "A clip whose body all clips get")
      ->type_name("FILE");
}

using Run = Status (*)(const DataOptions& options, const Console& console);

}  // namespace

std::vector<Command> AddDataCommands(CLI::App& app, const Console& console) {
  CLI::App* data = app.add_subcommand("data", kDescription);
  data->footer(kFooter);
  std::vector<Command> commands;
  const auto add = [&](const char* name, const char* help, Run run, const char* example) {
    auto options = std::make_shared<DataOptions>();
    CLI::App* command = data->add_subcommand(name, help);
    command->footer(fmt::format("Example:\n  {}", example));
    AddConnectionFlags(*command, options->connection);
    commands.push_back({command, [=, &console] { return run(*options, console); }});
    return std::pair(command, options);
  };
  const auto take_name = [](const std::pair<CLI::App*, Options>& added) {
    added.first->add_option("NAME", added.second->name, "The data set")->type_name("")->required();
  };
  const auto added = add("add", kAddDescription, RunAdd,
                         "poise data add kicks ~/hdm05 --class kick --license \"CC BY-SA 3.0\"");
  take_name(added);
  AddReadFlags(*added.first, *added.second);
  add("list", "List the data sets.", RunList, "poise data list --json");
  take_name(add("get", "Show what is in a data set.", RunGet, "poise data get hdm05"));
  take_name(add("delete", "Remove a data set; models that learned from it stay.", RunDelete,
                "poise data delete hdm05"));
  return commands;
}

}  // namespace poise::cli
