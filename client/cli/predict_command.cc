#include <fmt/format.h>

#include <memory>

#include "client/cli/clip_input.h"
#include "client/cli/commands.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "What comes next: the motion that follows the end of a file.\n\n"
    "A model looks at the last seconds of the clip and predicts the frames after it, on the same "
    "body and at the same frame rate. They are written as BVH, in the unit, axes and channels of a "
    "source that is BVH itself. predictor-cmu comes with the program; zero-velocity holds the last "
    "pose and constant-velocity goes on as the last two frames moved: the floors that a trained "
    "model has to beat.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise predict walk.bvh --horizon 0.1 --out next.bvh\n"
    "  poise predict kick.amc --model zero-velocity@1 --json";

struct PredictOptions {
  std::string file;
  std::string model = "predictor-cmu";
  double horizon_s = 0.4;
  int samples = 1;
  uint64_t seed = 0;
  std::string out;  // empty: nothing is written
  double timeout_s = 0;
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  ReaderFlags reader;
};

// "next.bvh", or "next_2.bvh" for the second of several futures.
std::string FuturePath(const std::string& out, size_t index) {
  if (index == 0) return out;
  const std::filesystem::path path = out;
  return (path.parent_path() /
          fmt::format("{}_{}{}", path.stem().string(), index + 1, path.extension().string()))
      .string();
}

StatusOr<std::vector<std::string>> WriteFutures(const PredictOptions& options,
                                                const api::Forecast& forecast,
                                                const motion::SourceConvention& source) {
  std::vector<std::string> files;
  if (options.out.empty()) return files;
  const bool was_bvh = source.format == motion::ClipFormat::kBvh;
  for (const auto& future : forecast.futures) {
    files.push_back(FuturePath(options.out, files.size()));
    POISE_RETURN_IF_ERROR(motion::WriteBvhFile(files.back(), std::get<motion::Clip>(future),
                                               was_bvh ? source : motion::UsualBvhConvention()));
  }
  return files;
}

Status RunPredict(PredictOptions& options, const Console& console) {
  if (options.timeout_s > 0) options.connection.timeout = absl::Seconds(options.timeout_s);
  POISE_ASSIGN_OR_RETURN(LoadedClip loaded, LoadClip(options.file, options.reader));
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(
      const api::Forecast forecast,
      client->Predict({.source = {std::move(loaded.file.clip), std::move(loaded.role_overrides)},
                       .model = options.model,
                       .horizon_s = options.horizon_s,
                       .samples = options.samples,
                       .seed = options.seed}));
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> files,
                         WriteFutures(options, forecast, loaded.file.convention));
  const std::string model = forecast.model + "@" + forecast.version;
  if (console.json()) {
    console.PrintJson({{"model", model},
                       {"frame_times_s", forecast.frame_times_s},
                       {"inpainted", forecast.inpainted},
                       {"deterministic", forecast.deterministic},
                       {"files", files}});
    return absl::OkStatus();
  }
  console.Print(fmt::format("{}: {} frames up to {:.3f} s after the last one", model,
                            forecast.frame_times_s.size(), forecast.frame_times_s.back()));
  for (const std::string& file : files) console.Print("BVH file: " + file);
  return absl::OkStatus();
}

void AddQueryFlags(CLI::App& command, PredictOptions& options) {
  command.add_option("--model", options.model, "NAME (its newest version) or NAME@VERSION")
      ->type_name("MODEL")
      ->capture_default_str();
  command.add_option("--horizon", options.horizon_s, "How far to look ahead, in seconds")
      ->type_name("SECONDS")
      ->capture_default_str();
  command.add_option("--samples", options.samples, "Futures, of a model that draws them")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Seed of what is drawn")
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace

Command AddPredictCommand(CLI::App& app, const Console& console) {
  auto options = std::make_shared<PredictOptions>();
  CLI::App* command = app.add_subcommand("predict", kDescription);
  command->footer(kFooter);
  command->add_option("FILE", options->file, "Motion file")->type_name("")->required();
  AddQueryFlags(*command, *options);
  command->add_option("--out", options->out, "BVH file for the future")->type_name("FILE");
  AddServerFlag(*command, options->connection.server);
  AddTimeoutFlag(*command, options->timeout_s);
  AddReaderFlags(*command, options->reader);
  AddJsonFlag(*command);
  return {command, [options, &console] { return RunPredict(*options, console); }};
}

}  // namespace poise::cli
