#include <fmt/format.h>

#include <memory>
#include <mutex>

#include "client/cli/commands.h"
#include "client/cli/file_access.h"
#include "client/cli/interrupt.h"
#include "client/cli/push_input.h"
#include "client/cli/push_report.h"
#include "client/client.h"
#include "core/motion/io/clip_file.h"

namespace poise::cli {
namespace {

namespace fs = std::filesystem;

constexpr char kDescription[] =
    "Forecast what people do after a push, on a Poise server.\n\n"
    "People stand in a formation (line:N, diamond:N, person 0 at the rear, facing +X) or as a "
    "scene "
    "file says. One BVH file is written for each, and scene.json beside them, which can be given "
    "to --people again.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise push --people line:10 --push 0:strong --out line\n"
    "  poise push --people diamond:13 --push 0:40Ns --duration 3 --out diamond --json\n"
    "  poise push --people line:1 --push 0:weak --push 0:medium@0.25 --push 0:strong@0.83\n"
    "  poise push --people line/scene.json --push 0:strong:180@0.5\n\n"
    "A push is PERSON:STRENGTH[:DIRECTION][@SECONDS]; strengths are weak (25 N s), medium (40), "
    "strong (65) or newton seconds, directions degrees to the left of +X.";

struct PushOptions {
  std::string people;
  std::vector<std::string> pushes;
  std::vector<std::string> assignments;  // of --set
  double mass_kg = 75;
  double duration_s = 0;
  std::string model;
  std::string out = "pushed";
  double timeout_s = 0;
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
};

StatusOr<api::PushSpec> ReadPeople(const PushOptions& options) {
  if (options.people.ends_with(".json")) return ReadSceneFile(options.people);
  api::PushSpec spec;
  POISE_ASSIGN_OR_RETURN(const std::vector<motion::Vec3> places, FormationPlaces(options.people));
  for (const motion::Vec3& place : places) {
    api::PushPerson person;
    person.mass_kg = options.mass_kg;
    person.place = place;
    spec.people.push_back(std::move(person));
  }
  return spec;
}

StatusOr<api::PushSpec> ReadSpec(const PushOptions& options) {
  POISE_ASSIGN_OR_RETURN(api::PushSpec spec, ReadPeople(options));
  for (const std::string& text : options.pushes) {
    POISE_ASSIGN_OR_RETURN(const api::PushForce push, ParsePush(text));
    spec.pushes.push_back(push);
  }
  if (options.duration_s != 0) spec.duration_s = options.duration_s;
  if (!options.model.empty()) spec.model = options.model;
  for (const std::string& assignment : options.assignments) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      return base::InvalidArgument("BAD_USAGE", "set",
                                   fmt::format("--set has '{}', expected KEY=VALUE", assignment));
    }
    spec.overrides[assignment.substr(0, equals)] = assignment.substr(equals + 1);
  }
  POISE_RETURN_IF_ERROR(spec.Validate());
  return spec;
}

StatusOr<PushReport> Receive(client::PushStream& stream) {
  POISE_ASSIGN_OR_RETURN(api::PushForecastScene scene, stream.Scene());
  PushReport report(std::move(scene));
  while (true) {
    POISE_ASSIGN_OR_RETURN(const auto frame, stream.Next());
    if (!frame) return report;
    POISE_RETURN_IF_ERROR(report.Add(*frame));
  }
}

base::Json PushesJson(const api::PushSpec& spec) {
  base::Json pushes = base::Json::array();
  for (const api::PushForce& push : spec.pushes) {
    pushes.push_back({{"person", push.person},
                      {"start_s", push.start_s},
                      {"duration_s", push.duration_s},
                      {"impulse_ns", {push.impulse_ns.x(), push.impulse_ns.z()}},
                      {"height", push.height}});
  }
  return pushes;
}

// Writes the clips and the scene file; returns the report as JSON with the files' paths.
StatusOr<base::Json> WriteResults(const PushOptions& options, const api::PushSpec& spec,
                                  const PushReport& report) {
  const fs::path folder = options.out;
  std::vector<std::string> names, paths;
  for (int i = 0; i < report.num_people(); ++i) {
    POISE_ASSIGN_OR_RETURN(const motion::Clip clip, report.ClipOf(i));
    names.push_back(fmt::format("person_{:03}.bvh", i));
    paths.push_back((folder / names.back()).string());
    POISE_RETURN_IF_ERROR(WriteFile(paths.back(), motion::EncodeBvh(clip)));
  }
  base::Json scene = report.ToJson(names);
  scene["duration_s"] = spec.duration_s;
  scene["pushes"] = PushesJson(spec);
  POISE_RETURN_IF_ERROR(WriteFile(folder / "scene.json", scene.dump(2) + "\n"));
  return report.ToJson(paths);
}

Status RunPush(PushOptions& options, const Console& console) {
  if (options.timeout_s > 0) options.connection.timeout = absl::Seconds(options.timeout_s);
  POISE_ASSIGN_OR_RETURN(const api::PushSpec spec, ReadSpec(options));
  std::mutex mutex;
  std::unique_ptr<client::PushStream> stream;
  InterruptHandler interrupt([&] {
    const std::lock_guard lock(mutex);
    if (stream != nullptr) stream->Cancel();
  });
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_RETURN_IF_ERROR(MakeFolder(options.out));
  POISE_ASSIGN_OR_RETURN(auto started, client->ForecastPush(spec));
  {
    const std::lock_guard lock(mutex);
    stream = std::move(started);
    if (interrupt.interrupted()) stream->Cancel();
  }
  const StatusOr<PushReport> report = Receive(*stream);
  {
    const std::lock_guard lock(mutex);
    stream.reset();
  }
  POISE_RETURN_IF_ERROR(report.status());
  POISE_ASSIGN_OR_RETURN(const base::Json json, WriteResults(options, spec, *report));
  if (console.json()) {
    console.PrintJson(json);
    return absl::OkStatus();
  }
  console.Print(report->Text());
  console.Print(fmt::format("BVH files and scene.json: {}", options.out));
  return absl::OkStatus();
}

}  // namespace

Command AddPushCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<PushOptions>();
  CLI::App* command = app.add_subcommand("push", kDescription);
  command->footer(kFooter);
  command->add_option("--people", options->people, "line:N, diamond:N or a scene file")
      ->type_name("PEOPLE")
      ->required();
  command->add_option("--push", options->pushes, "A push; repeatable")
      ->type_name("PUSH")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--mass", options->mass_kg, "Of each person in a formation")
      ->type_name("KG")
      ->capture_default_str();
  command->add_option("--duration", options->duration_s, "Of the forecast; else the scene's or 2 s")
      ->type_name("SECONDS");
  command
      ->add_option("--model", options->model, "statue or a trained model; else the one that ships")
      ->type_name("NAME");
  command->add_option("--set", options->assignments, "A hyper-parameter; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Folder for the files, made when absent")
      ->type_name("FOLDER")
      ->capture_default_str();
  AddServerFlag(*command, options->connection.server);
  AddTimeoutFlag(*command, options->timeout_s);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunPush(*options, console); }};
}

}  // namespace poise::cli
