// Trains a predictor on a published benchmark and tests it beside the floors:
//
//   predictor_learning --data DIR/cmu --protocol seeded75 all --seeds 3 --out r.csv
//   predictor_learning --data DIR/hdm05 --benchmark hdm05 --class kickLFront1Reps --left-out tr
//       --protocol loso
//
// The results file has the columns of `poise evaluate`. Progress goes to standard error.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "CLI/CLI.hpp"
#include "core/pipeline/evaluate_predictor.h"
#include "core/prediction/predictor_registry.h"
#include "core/prediction/training/train_predictor.h"

namespace poise {
namespace {

struct Options {
  std::string data;
  std::string benchmark = "cmu";
  std::string action_class;  // of HDM05; empty: all
  std::string left_out;
  std::vector<std::string> protocols = {"seeded75"};
  int seeds = 1;
  uint64_t first_seed = 1;
  std::vector<std::string> assignments;
  std::string out;
  std::string preset = "recommended";
  std::string license;              // for the card
  std::vector<std::string> models;  // folders, to be tested
  std::string save;                 // prefix of the models' folders
};

StatusOr<motion::BenchmarkClips> LoadClips(const Options& options) {
  if (options.benchmark == "cmu") return motion::LoadCmuBenchmark(options.data);
  return motion::LoadHdm05Benchmark(options.data, options.action_class, options.left_out);
}

StatusOr<prediction::PredictorTraining> Training(const Options& options) {
  POISE_ASSIGN_OR_RETURN(prediction::PredictorTraining config,
                         prediction::PredictorTraining::FromPreset(options.preset));
  base::Overrides overrides;
  for (const std::string& assignment : options.assignments) {
    const size_t equals = assignment.find('=');
    overrides[assignment.substr(0, equals)] =
        equals == std::string::npos ? "" : assignment.substr(equals + 1);
  }
  POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  return config;
}

/// Rows of the results file, and a table for people.
class Results {
 public:
  explicit Results(const motion::BenchmarkClips& clips) : clips_(clips) {}

  Status Test(const prediction::Predictor& predictor, const pipeline::ScoreLabels& labels,
              const std::vector<std::string>& protocols) {
    for (const std::string& name : protocols) {
      POISE_ASSIGN_OR_RETURN(const motion::EvaluationProtocol protocol, motion::FindProtocol(name));
      POISE_ASSIGN_OR_RETURN(const pipeline::PredictorScores scores,
                             pipeline::EvaluatePredictor(predictor, clips_, protocol, {}));
      rows_ +=
          pipeline::ScoresCsvRows(scores, labels, protocol, clips_.test.front().clip.frame_rate());
      std::printf("%-18s %-9s seed %d  mean", labels.model.c_str(), name.c_str(),
                  static_cast<int>(labels.seed));
      for (const int frame : protocol.frames) {
        if (frame < static_cast<int>(scores.mean.size())) {
          std::printf("  f%d %.3f", frame, scores.mean[frame]);
        }
      }
      std::printf("\n");
      std::fflush(stdout);
    }
    return absl::OkStatus();
  }

  Status Write(const std::string& path) const {
    if (path.empty()) return absl::OkStatus();
    std::ofstream(path) << pipeline::ScoresCsvHeader() << rows_;
    return absl::OkStatus();
  }

 private:
  const motion::BenchmarkClips& clips_;
  std::string rows_;
};

void PrintProgress(const base::Progress& progress) {
  const auto metric = [&](const char* name) {
    const auto found = progress.metrics.find(name);
    return found == progress.metrics.end() ? 0.0 : found->second;
  };
  std::fprintf(stderr, "\rstep %ld of %ld  loss %.4f  validation %.4f  best %.4f  eta %.0f s   ",
               static_cast<long>(progress.step), static_cast<long>(progress.total),
               metric("predictor.loss"), metric("validation"), metric("best_validation"),
               metric("eta_s"));
}

std::string TrainedOn(const Options& options) {
  if (options.benchmark == "cmu") return "all training sequences of the prediction benchmark";
  return fmt::format("{}{}",
                     options.action_class.empty() ? "all classes" : "class " + options.action_class,
                     options.left_out.empty() ? "" : ", without actor " + options.left_out);
}

// A model folder, and its learning curve beside it.
Status Save(const Options& options, const prediction::PredictorResult& trained, uint64_t seed) {
  const std::filesystem::path folder = fmt::format("{}_{}", options.save, seed);
  std::filesystem::create_directories(folder);
  std::ofstream(folder.string() + "_curve.csv") << trained.curve_csv;
  return artifacts::WriteModelFolder(trained.model, folder);
}

Status LearnAndTest(const Options& options, const motion::BenchmarkClips& clips, uint64_t seed,
                    Results& results) {
  POISE_ASSIGN_OR_RETURN(const prediction::PredictorTraining config, Training(options));
  base::RunContext context;
  context.seed = seed;
  context.progress = PrintProgress;
  POISE_ASSIGN_OR_RETURN(const prediction::PredictorResult trained,
                         prediction::TrainPredictor({.clips = clips,
                                                     .config = config,
                                                     .preset = options.preset,
                                                     .data = options.benchmark,
                                                     .data_fingerprint = "",
                                                     .data_license = options.license,
                                                     .trained_on = TrainedOn(options)},
                                                    context));
  std::fprintf(stderr, "\n");
  const api::ModelCard& card = trained.model.card;
  const auto validation = card.scores.find("validation_rad");
  std::printf("trained %ld steps in %.0f s, best after %ld: validation %.4f\n",
              static_cast<long>(card.steps), trained.seconds, static_cast<long>(trained.best_step),
              validation == card.scores.end() ? 0.0 : validation->second);
  if (!options.save.empty()) POISE_RETURN_IF_ERROR(Save(options, trained, seed));
  POISE_ASSIGN_OR_RETURN(const auto predictor, prediction::MakeTrainedPredictor(trained.model));
  return results.Test(*predictor, {config.family, options.preset, seed}, options.protocols);
}

Status Run(const Options& options) {
  POISE_ASSIGN_OR_RETURN(const motion::BenchmarkClips clips, LoadClips(options));
  Results results(clips);
  for (const std::string& name : prediction::BuiltInPredictorNames()) {
    POISE_RETURN_IF_ERROR(results.Test(*prediction::FindBuiltInPredictor(name),
                                       {name + "@1", "", 0}, options.protocols));
  }
  for (const std::string& folder : options.models) {
    POISE_ASSIGN_OR_RETURN(const artifacts::ModelArtifact model,
                           artifacts::ReadModelFolder(folder));
    POISE_ASSIGN_OR_RETURN(const auto predictor, prediction::MakeTrainedPredictor(model));
    const std::string name = std::filesystem::path(folder).parent_path().filename().string();
    POISE_RETURN_IF_ERROR(
        results.Test(*predictor, {name, model.card.preset, model.card.seed}, options.protocols));
  }
  for (int i = 0; i < options.seeds; ++i) {
    POISE_RETURN_IF_ERROR(LearnAndTest(options, clips, options.first_seed + i, results));
    POISE_RETURN_IF_ERROR(results.Write(options.out));
  }
  return results.Write(options.out);
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::Options options;
  CLI::App app("Trains a predictor and tests it beside the floors.");
  app.add_option("--data", options.data, "Folder of the benchmark")->required();
  app.add_option("--benchmark", options.benchmark)->check(CLI::IsMember({"cmu", "hdm05"}));
  app.add_option("--class", options.action_class, "HDM05 class; all without it");
  app.add_option("--left-out", options.left_out, "HDM05 actor that is the test");
  app.add_option("--protocol", options.protocols, "seeded60, seeded75, all, loso");
  app.add_option("--model", options.models, "Folder of a trained model, tested too; repeatable")
      ->allow_extra_args(false);
  app.add_option("--seeds", options.seeds, "Trainings; 0: the floors alone");
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--out", options.out, "Results file (CSV)");
  app.add_option("--preset", options.preset, "recommended or gcn");
  app.add_option("--license", options.license, "Of the data, for the model's card");
  app.add_option("--save", options.save, "Prefix for folders of models and for learning curves");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
