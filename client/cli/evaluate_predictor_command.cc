#include <fmt/format.h>

#include <memory>
#include <utility>

#include "client/cli/benchmark_form_flags.h"
#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/cli/jobs/job_wait.h"
#include "client/cli/table.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "How far predictions are from what came, beside holding still and going on.\n\n"
    "A job that tests by a published protocol: seeded60 and seeded75 (eight drawn windows a clip, "
    "CMU), all (every such window), loso (HDM05, the actor of --hold-out). The error is the "
    "published one, of Euler angles in radians; the mean gives every action the same weight.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise evaluate predictor kick-next --data hdm05 --class kick --hold-out tr\n"
    "  poise evaluate predictor predictor-cmu --data cmu-test --train-data cmu-train --body all "
    "--rate 60 --protocol seeded75 --out scores.csv";

struct Options {
  std::string model, data, action_class, hold_out, train_data;
  std::string protocol = "loso";
  motion::BenchmarkForm form;
  std::string out;
  std::string request_id;
  bool detach = false;
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
};

StatusOr<api::CreateJob> Request(Options options, client::Client& client) {
  api::CreateJob request;
  request.spec.kind = "evaluate_predictor";
  request.request_id = options.request_id;
  POISE_ASSIGN_OR_RETURN(const api::DataSet data, client.GetDataSet(options.data));
  base::Json& parameters = request.spec.parameters;
  parameters = base::FieldsToJson(options.form.Fields());
  parameters.update({{"data", data.name},
                     {"data_artifact", data.artifact},
                     {"action_class", options.action_class},
                     {"hold_out", options.hold_out},
                     {"protocol", options.protocol}});
  if (!options.train_data.empty()) {
    POISE_ASSIGN_OR_RETURN(const api::DataSet train, client.GetDataSet(options.train_data));
    parameters["train_artifact"] = train.artifact;
  }
  if (options.model.empty()) return request;
  // Pins the version that the name means now.
  POISE_ASSIGN_OR_RETURN(const api::Model model, client.GetModel(options.model));
  const std::string version = model.name + "@" + model.version;
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored, client.ExportModel(version));
  parameters["model"] = version;
  parameters["model_artifact"] = stored.name;
  return request;
}

// The report of a job that SUCCEEDED; writes its table of scores where that is wanted.
StatusOr<base::Json> Fetch(const Options& options, const api::Job& job, client::Client& client) {
  base::Json report;
  for (const api::JobArtifact& file : job.artifacts) {
    if (file.name == "scores.csv" && !options.out.empty()) {
      POISE_RETURN_IF_ERROR(client.DownloadFile(file.artifact, options.out));
    }
    if (file.name != "manifest.json") continue;
    POISE_ASSIGN_OR_RETURN(const std::string text, client.Download(file.artifact));
    POISE_ASSIGN_OR_RETURN(const base::Json manifest, base::ParseJson(text, file.name));
    report = manifest.value("report", base::Json());
  }
  if (report.contains("models")) return report;
  return base::Internal("BAD_ANSWER", "the job has no report");
}

void Print(const base::Json& report, const Console& console) {
  std::vector<std::string> header = {"mean error [rad] after"};
  for (const base::Json& horizon : report["horizons_ms"]) {
    header.push_back(fmt::format("{:.0f} ms", horizon.get<double>()));
  }
  Table table(std::move(header));
  for (const base::Json& model : report["models"]) {
    std::vector<std::string> row = {model["model"]};
    for (const base::Json& error : model["errors"]) {
      row.push_back(error.is_null() ? "" : fmt::format("{:.3f}", error.get<double>()));
    }
    table.AddRow(std::move(row));
  }
  console.Print(table.Text());
  console.Print(fmt::format("protocol {}, {} windows", report["protocol"].get<std::string>(),
                            report["models"].front()["windows"].get<int>()));
}

Status Run(const Options& options, const Console& console) {
  JobWait wait({.wait = !options.detach}, console);
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const api::CreateJob request, Request(options, *client));
  POISE_ASSIGN_OR_RETURN(api::Job job, client->CreateJob(request));
  if (options.detach) return wait.Answer(*client, std::move(job));
  POISE_ASSIGN_OR_RETURN(job, wait.End(*client, std::move(job)));
  if (job.state != api::JobState::kSucceeded) return wait.Report(job);
  POISE_ASSIGN_OR_RETURN(base::Json report, Fetch(options, job, *client));
  if (console.json()) {
    report["job"] = "jobs/" + job.id;
    console.PrintJson(report);
  } else {
    Print(report, console);
  }
  return absl::OkStatus();
}

}  // namespace

Command AddEvaluatePredictorCommand(CLI::App& evaluate, const Console& console) {
  auto options = std::make_shared<Options>();
  CLI::App* command = evaluate.add_subcommand("predictor", kDescription);
  command->footer(kFooter);
  command->add_option("MODEL", options->model, "NAME or NAME@VERSION; without, the floors alone")
      ->type_name("");
  command->add_option("--data", options->data, "Data set to test on (poise data list)")
      ->type_name("NAME")
      ->required();
  command->add_option("--class", options->action_class, "Class of the clips: kick, jog, ...")
      ->type_name("CLASS");
  command->add_option("--hold-out", options->hold_out, "Test on the clips of this actor alone")
      ->type_name("ACTOR");
  command
      ->add_option("--train-data", options->train_data,
                   "Data set that says which columns and actions count")
      ->type_name("NAME");
  command->add_option("--protocol", options->protocol, "seeded60, seeded75, all or loso")
      ->type_name("NAME")
      ->capture_default_str();
  AddBenchmarkFormFlags(*command, options->form);
  command->add_option("--out", options->out, "Write every action's errors as CSV")
      ->type_name("FILE");
  command->add_option("--request-id", options->request_id, "The same id again is the same job")
      ->type_name("ID");
  command->add_flag("--detach", options->detach, "Print the job and do not wait");
  AddConnectionFlags(*command, options->connection);
  return {command, [options, &console] { return Run(*options, console); }};
}

}  // namespace poise::cli
