// Trains a push model on the recorded takes and writes its folder:
//
//   push_learning --data DIR/fzj_push --seed 1 --save models/push-fzj/1
//   push_learning --data DIR/fzj_push --seed 1 --set protocol=A --save /tmp/a
//   push_learning --data DIR/fzj_push --seed 1 --preset paper --save /tmp/paper
//
// Goes on from SAVE.checkpoint when it was interrupted. Progress goes to standard error.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "CLI/CLI.hpp"
#include "bench/checkpoint_file.h"
#include "bench/overrides.h"
#include "core/artifacts/model_artifact.h"
#include "core/push/presets/train_preset.h"
#include "core/push/takes/fzj_takes.h"

namespace poise {
namespace {

struct Options {
  std::string data, save, license;
  std::string preset = "recommended";
  std::vector<std::string> assignments;
  uint64_t seed = 1;
};

void PrintProgress(const base::Progress& progress) {
  if (progress.step % 60 != 0) return;
  std::fprintf(stderr, "%s: step %ld of %ld", progress.message.c_str(),
               static_cast<long>(progress.step), static_cast<long>(progress.total));
  for (const auto& [name, value] : progress.metrics) {
    std::fprintf(stderr, "  %s %.4f", name.c_str(), value);
  }
  std::fprintf(stderr, "\n");
}

Status Run(const Options& options) {
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes, push::ReadTakes(options.data));
  base::RunContext context;
  context.seed = options.seed;
  context.progress = PrintProgress;
  const bench::CheckpointFile checkpoint(options.save + ".checkpoint");
  POISE_ASSIGN_OR_RETURN(
      const push::PushResult trained,
      push::TrainPreset({.takes = takes,
                         .preset = options.preset,
                         .overrides = bench::ToOverrides(options.assignments),
                         .data = "FZJ Push",
                         .data_license = options.license},
                        context, checkpoint.Read(), checkpoint.Sink(absl::Minutes(1))));
  std::filesystem::create_directories(options.save);
  POISE_RETURN_IF_ERROR(artifacts::WriteModelFolder(trained.model, options.save));
  std::ofstream(options.save + "_curve.csv") << trained.curve_csv;
  checkpoint.Remove();
  std::printf("trained %ld steps in %.0f s:", static_cast<long>(trained.model.card.steps),
              trained.seconds);
  for (const auto& [name, value] : trained.model.card.scores) {
    std::printf(" %s %.4f", name.c_str(), value);
  }
  std::printf("\n");
  return absl::OkStatus();
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::Options options;
  CLI::App app("Trains a push model.");
  app.add_option("--data", options.data, "Folder of FZJ Push")->required();
  app.add_option("--save", options.save, "Folder of the model")->required();
  app.add_option("--seed", options.seed);
  app.add_option("--preset", options.preset, "recommended | paper");
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--license", options.license, "Of the data, for the model's card");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
