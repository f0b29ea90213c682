#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "client/cli/jobs/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/client.h"
#include "proto/convert/job_convert.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "Fetch the files of a job that SUCCEEDED.\n\n"
    "Each is checked against its digest and appears whole or not at all. What is there already is "
    "not fetched again, and what broke off is gone on with, also after a Ctrl-C.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise jobs result jobs/019abc --out kicks\n"
    "  poise jobs result 019abc --artifact manifest.json --json";

struct ResultOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string name;
  std::string out;
  std::string artifact;
};

Status RunResult(const ResultOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::string id, ParseJobName(options.name));
  const std::filesystem::path folder = options.out.empty() ? id : options.out;
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const auto artifacts,
                         client->Handle(id).SaveResult(folder, options.artifact));
  base::Json files = base::Json::array();
  for (const api::JobArtifact& artifact : artifacts) {
    const std::string file = (folder / artifact.name).string();
    files.push_back({{"name", artifact.name},
                     {"file", file},
                     {"artifact", artifact.artifact},
                     {"size_bytes", artifact.size_bytes},
                     {"media_type", artifact.media_type}});
    if (!console.json()) console.Print(file);
  }
  if (console.json()) {
    console.PrintJson(
        {{"name", convert::JobName(id)}, {"out", folder.string()}, {"files", std::move(files)}});
  }
  return absl::OkStatus();
}

}  // namespace

Command AddJobsResultCommand(CLI::App& jobs, const Console& console) {
  auto options = std::make_shared<ResultOptions>();
  CLI::App* command = jobs.add_subcommand("result", kDescription);
  command->footer(kFooter);
  command->add_option("JOB", options->name, "jobs/ID or ID")->type_name("")->required();
  command->add_option("--out", options->out, "Folder, made when absent (default: the job's ID)")
      ->type_name("FOLDER");
  command->add_option("--artifact", options->artifact, "Only the file of this name")
      ->type_name("NAME");
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return RunResult(*options, console); }};
}

}  // namespace poise::cli
