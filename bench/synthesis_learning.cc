// Trains the VAE on one class without one actor, then measures what it makes beside the clips that
// it learned from and those of the actor:
//
//   synthesis_learning --data DIR/hdm05 --class kick --left-out bd --save kick-bd
//   synthesis_learning --data DIR/hdm05 --class kick --left-out bd --set trainer.steps=500
//
// Progress goes to standard error.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <fstream>

#include "CLI/CLI.hpp"
#include "core/artifacts/model_artifact.h"
#include "core/motion/dataset/clip_folder.h"
#include "core/synthesis/vae/vae_motions.h"
#include "core/synthesis/vae/vae_trainer.h"

namespace poise {
namespace {

struct Options {
  std::string data;
  std::string action_class;
  std::string left_out;
  std::string preset = "recommended";
  std::vector<std::string> assignments;
  uint64_t seed = 1;
  std::string save;  // prefix of files
  bool lengths = false;
};

StatusOr<synthesis::VaeConfig> Config(const Options& options) {
  POISE_ASSIGN_OR_RETURN(synthesis::VaeConfig config,
                         synthesis::VaeConfig::FromPreset(options.preset));
  base::Overrides overrides;
  for (const std::string& assignment : options.assignments) {
    const size_t equals = assignment.find('=');
    overrides[assignment.substr(0, equals)] =
        equals == std::string::npos ? "" : assignment.substr(equals + 1);
  }
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
  return config;
}

void PrintProgress(const base::Progress& progress) {
  std::fprintf(stderr, "step %ld of %ld", static_cast<long>(progress.step),
               static_cast<long>(progress.total));
  for (const auto& [name, value] : progress.metrics) {
    if (name.find("gradient") == std::string::npos) {
      std::fprintf(stderr, "  %s %.4g", name.c_str(), value);
    }
  }
  std::fprintf(stderr, "\n");
}

Status PrintLengths(const synthesis::VaeTask& task) {
  POISE_ASSIGN_OR_RETURN(const synthesis::Fold fold,
                         synthesis::PrepareFold(task.clips, task.fold, task.config.frame_rate));
  std::vector<long> lengths;
  for (const auto& motion : fold.train) lengths.push_back(motion.phases.front().rows());
  fmt::print("{}\n", fmt::join(lengths, ","));
  return absl::OkStatus();
}

Status Run(const Options& options) {
  POISE_ASSIGN_OR_RETURN(
      motion::ClipSet clips,
      motion::ReadClipFolder(options.data, {.action_class = options.action_class}));
  synthesis::VaeTask task;
  POISE_ASSIGN_OR_RETURN(task.config, Config(options));
  task.clips = std::move(clips.clips);
  task.fold = {.action_class = options.action_class, .held_out = options.left_out};
  task.preset = options.preset;
  if (options.lengths) return PrintLengths(task);
  base::RunContext context;
  context.seed = options.seed;
  context.progress = PrintProgress;
  POISE_ASSIGN_OR_RETURN(synthesis::VaeResult result, synthesis::TrainVae(task, context));
  for (const auto& [name, value] : result.model.card.scores) {
    std::printf("%-30s %.4f\n", name.c_str(), value);
  }
  if (!options.save.empty()) {
    std::ofstream(options.save + "_curve.csv") << result.curve_csv;
    std::ofstream(options.save + ".safetensors", std::ios::binary)
        << artifacts::PackModel(std::move(result.model));
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::Options options;
  CLI::App app("Trains the VAE and measures what it makes.");
  app.add_option("--data", options.data, "Folder of clips")->required();
  app.add_option("--class", options.action_class, "Of the clips")->required();
  app.add_option("--left-out", options.left_out, "Actor who is not learned from")->required();
  app.add_option("--preset", options.preset, "recommended or paper");
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--seed", options.seed);
  app.add_option("--save", options.save, "Prefix for model and learning curve");
  app.add_flag("--lengths", options.lengths, "Print the lengths of the motions and end");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
