#include <fmt/format.h>

#include <memory>
#include <utility>

#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/table.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Trained networks on a server: list, get, import, export, default, delete.\n\n"
    "A model is NAME (its default version: the one that was set, else the newest) or NAME@VERSION. "
    "Its card says what built it, what it learned from and how well.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise models list\n"
    "  poise models export kick-vae@2 --out kick-vae.safetensors\n"
    "  poise models import kick-vae kick-vae.safetensors\n"
    "  poise models default kick-vae@1";
constexpr int kIndent = 2;

struct ModelsOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string model;
  std::string file;
};
using Options = std::shared_ptr<ModelsOptions>;

void PrintModel(const api::Model& model, const Console& console) {
  if (console.json()) {
    console.PrintJson(api::ToJson(model));
  } else {
    console.Print(api::ToJson(model).dump(kIndent));
  }
}

Status RunList(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const std::vector<api::Model> models, client->ListModels());
  Table table({"model", "family", "trained on", "MB", "default", "shipped"});
  for (const api::Model& model : models) {
    if (console.json()) console.PrintJson(api::ToJson(model));
    table.AddRow({fmt::format("{}@{}", model.name, model.version), model.card.family,
                  fmt::format("{}: {}", model.card.data, model.card.trained_on),
                  fmt::format("{:.1f}", 1e-6 * static_cast<double>(model.size_bytes)),
                  model.is_default ? "yes" : "", model.shipped ? "yes" : ""});
  }
  if (!console.json()) console.Print(models.empty() ? "no models" : table.Text());
  return absl::OkStatus();
}

Status RunGet(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::Model model, client->GetModel(options.model));
  PrintModel(model, console);
  return absl::OkStatus();
}

Status RunImport(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  std::string artifact = options.file;
  if (!artifact.starts_with("artifacts/")) {
    POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client->UploadFile(options.file));
    artifact = stored.name;
  }
  POISE_ASSIGN_OR_RETURN(const api::Model model, client->ImportModel(options.model, artifact));
  PrintModel(model, console);
  return absl::OkStatus();
}

Status RunExport(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client->ExportModel(options.model));
  const std::string file = options.file.empty() ? options.model + ".safetensors" : options.file;
  POISE_RETURN_IF_ERROR(client->DownloadFile(stored.name, file));
  if (console.json()) {
    console.PrintJson(
        {{"model", options.model}, {"file", file}, {"size_bytes", stored.size_bytes}});
  } else {
    console.Print(fmt::format("{}, {} bytes", file, stored.size_bytes));
  }
  return absl::OkStatus();
}

Status RunDefault(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::Model model, client->SetDefaultModel(options.model));
  PrintModel(model, console);
  return absl::OkStatus();
}

Status RunDelete(const ModelsOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_RETURN_IF_ERROR(client->DeleteModel(options.model));
  if (console.json()) {
    console.PrintJson({{"model", options.model}, {"deleted", true}});
  } else {
    console.Print(fmt::format("{} deleted", options.model));
  }
  return absl::OkStatus();
}

using Run = Status (*)(const ModelsOptions& options, const Console& console);

}  // namespace

std::vector<Command> AddModelsCommands(CLI::App& app, const Console& console) {
  CLI::App* models = app.add_subcommand("models", kDescription);
  models->footer(kFooter);
  std::vector<Command> commands;
  const auto add = [&](const char* name, const char* help, Run run, const char* example) {
    auto options = std::make_shared<ModelsOptions>();
    CLI::App* command = models->add_subcommand(name, help);
    command->footer(fmt::format("Example:\n  {}", example));
    AddConnectionFlags(*command, options->connection);
    commands.push_back({command, [=, &console] { return run(*options, console); }});
    return std::pair(command, options);
  };
  const auto take_model = [](const std::pair<CLI::App*, Options>& added, const char* help) {
    added.first->add_option("MODEL", added.second->model, help)->type_name("")->required();
  };
  add("list", "List the models.", RunList, "poise models list --json");
  take_model(add("get", "Show a model's card.", RunGet, "poise models get kick-vae"),
             "NAME or NAME@VERSION");
  const auto import = add("import", "Give a model file a name: it becomes the next version.",
                          RunImport, "poise models import kick-vae kick-vae.safetensors");
  take_model(import, "NAME");
  import.first->add_option("FILE", import.second->file, "A file, or artifacts/SHA256 of a job")
      ->type_name("")
      ->required();
  const auto exported = add("export", "Write a model, with its card, to one safetensors file.",
                            RunExport, "poise models export kick-vae@2 --out kick-vae.safetensors");
  take_model(exported, "NAME or NAME@VERSION");
  exported.first->add_option("--out", exported.second->file, "Default: MODEL.safetensors")
      ->type_name("FILE");
  take_model(add("default", "Say which version the bare name means.", RunDefault,
                 "poise models default kick-vae@1"),
             "NAME@VERSION");
  take_model(add("delete", "Remove a version; its number is not given again.", RunDelete,
                 "poise models delete kick-vae@1"),
             "NAME@VERSION");
  return commands;
}

}  // namespace poise::cli
