// Trains a predictor on a published benchmark and tests it beside the floors:
//
//   predictor_learning --data DIR/cmu --protocol seeded75 all --seeds 3 --out r.csv
//   predictor_learning --data DIR/hdm05 --benchmark hdm05 --class kickLFront1Reps
//       --preset rnn-hdm05 --protocol loso --save models/kick
//
// --begin writes what bench/train_baselines.py trains from, instead of training.
//
// HDM05 without one actor at a time: a training per actor who is left out, and their mean. What was
// saved is not trained again, and a training that was interrupted goes on. The results file has the
// columns of `poise evaluate`. Progress goes to standard error.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "CLI/CLI.hpp"
#include "bench/checkpoint_file.h"
#include "bench/overrides.h"
#include "core/pipeline/evaluate_predictor.h"
#include "core/prediction/predictor_registry.h"
#include "core/prediction/training/train_predictor.h"

namespace poise {
namespace {

using prediction::PredictorPtr;

constexpr absl::Duration kCheckpointInterval = absl::Minutes(1);

struct Options {
  std::string data;
  std::string benchmark = "cmu";
  std::string action_class;           // of HDM05; empty: all
  std::vector<std::string> left_out;  // empty: each actor in turn
  std::vector<std::string> protocols = {"seeded75"};
  int seeds = 1;
  uint64_t first_seed = 1;
  std::vector<std::string> assignments;
  std::string out;
  std::string preset = "recommended";
  std::string license;              // for the card
  std::vector<std::string> models;  // folders, to be tested
  std::string save;                 // prefix of the models' folders
  std::string begin;                // prefix of what is written to be trained elsewhere
};

base::CancellationToken& Stop() {
  static base::CancellationToken token;
  return token;
}

// Sequences to learn from and to test with; of HDM05 the test is one actor.
struct Fold {
  std::string actor;  // empty: of CMU
  motion::BenchmarkClips clips;
};

StatusOr<std::vector<Fold>> LoadFolds(const Options& options) {
  std::vector<Fold> folds;
  if (options.benchmark == "cmu") {
    POISE_ASSIGN_OR_RETURN(motion::BenchmarkClips clips, motion::LoadCmuBenchmark(options.data));
    folds.push_back({"", std::move(clips)});
    return folds;
  }
  std::vector<std::string> actors = options.left_out;
  if (actors.empty()) {
    POISE_ASSIGN_OR_RETURN(actors, motion::Hdm05Actors(options.data, options.action_class));
  }
  for (const std::string& actor : actors) {
    POISE_ASSIGN_OR_RETURN(motion::BenchmarkClips clips,
                           motion::LoadHdm05Benchmark(options.data, options.action_class, actor));
    folds.push_back({actor, std::move(clips)});
  }
  return folds;
}

StatusOr<prediction::PredictorTraining> Training(const Options& options) {
  POISE_ASSIGN_OR_RETURN(prediction::PredictorTraining config,
                         prediction::PredictorTraining::FromPreset(options.preset));
  POISE_RETURN_IF_ERROR(
      base::ApplyOverrides(bench::ToOverrides(options.assignments), config.Fields()));
  POISE_RETURN_IF_ERROR(config.Validate());
  return config;
}

// Scores of the folds as those of one test: each fold is an action of it, named after its actor.
pipeline::PredictorScores Together(const std::vector<Fold>& folds,
                                   std::vector<pipeline::PredictorScores> scores) {
  if (folds.size() == 1) return scores.front();
  pipeline::PredictorScores all{.actions = {},
                                .mean = std::vector<double>(scores.front().mean.size())};
  for (size_t i = 0; i < folds.size(); ++i) {
    for (pipeline::ActionErrors& action : scores[i].actions) {
      action.action += "-" + folds[i].actor;
      all.actions.push_back(std::move(action));
    }
    for (size_t frame = 0; frame < all.mean.size(); ++frame) {
      all.mean[frame] += scores[i].mean[frame] / static_cast<double>(folds.size());
    }
  }
  return all;
}

using CardScores = decltype(api::ModelCard::scores);

/// Rows of the results file, and a table for people.
class Results {
 public:
  explicit Results(const std::vector<Fold>& folds) : folds_(folds) {}

  /// A predictor for each fold; returns what each fold's card may say of it.
  StatusOr<std::vector<CardScores>> Test(const std::vector<PredictorPtr>& predictors,
                                         const pipeline::ScoreLabels& labels,
                                         const std::vector<std::string>& protocols) {
    std::vector<CardScores> of_folds(folds_.size());
    for (const std::string& name : protocols) {
      POISE_ASSIGN_OR_RETURN(const motion::EvaluationProtocol protocol, motion::FindProtocol(name));
      std::vector<pipeline::PredictorScores> scores;
      for (size_t i = 0; i < folds_.size(); ++i) {
        POISE_ASSIGN_OR_RETURN(
            scores.emplace_back(),
            pipeline::EvaluatePredictor(*predictors[i], folds_[i].clips, protocol, {}));
        const std::vector<double>& mean = scores.back().mean;
        for (const size_t frame : protocol.frames) {
          if (frame < mean.size())
            of_folds[i][fmt::format("{}_frame_{}_rad", name, frame)] = mean[frame];
        }
      }
      const pipeline::PredictorScores all = Together(folds_, std::move(scores));
      rows_ += pipeline::ScoresCsvRows(all, labels, protocol,
                                       folds_[0].clips.test.front().clip.frame_rate());
      std::printf("%-18s %-9s seed %d  mean", labels.model.c_str(), name.c_str(),
                  static_cast<int>(labels.seed));
      for (const int frame : protocol.frames) {
        if (frame < static_cast<int>(all.mean.size())) {
          std::printf("  f%d %.3f", frame, all.mean[frame]);
        }
      }
      std::printf("\n");
      std::fflush(stdout);
    }
    return of_folds;
  }

  Status Write(const std::string& path) const {
    if (path.empty()) return absl::OkStatus();
    std::ofstream(path) << pipeline::ScoresCsvHeader() << rows_;
    return absl::OkStatus();
  }

 private:
  const std::vector<Fold>& folds_;
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

std::string TrainedOn(const Options& options, const Fold& fold) {
  if (options.benchmark == "cmu") return "all training sequences of the prediction benchmark";
  return fmt::format("{}{}",
                     options.action_class.empty() ? "all classes" : "class " + options.action_class,
                     fold.actor.empty() ? "" : ", without actor " + fold.actor);
}

// Where a fold's files are, and with a seed a training's: the model's folder, and files beside it.
std::string PathOf(const std::string& prefix, const Fold& fold) {
  return prefix + (fold.actor.empty() ? "" : "_" + fold.actor);
}
std::filesystem::path FolderOf(const std::string& prefix, const Fold& fold, uint64_t seed) {
  return fmt::format("{}_{}", PathOf(prefix, fold), seed);
}

StatusOr<prediction::PredictorTask> Task(const Options& options, const Fold& fold) {
  POISE_ASSIGN_OR_RETURN(prediction::PredictorTraining config, Training(options));
  return prediction::PredictorTask{.clips = fold.clips,
                                   .config = std::move(config),
                                   .preset = options.preset,
                                   .data = options.benchmark,
                                   .data_fingerprint = "",
                                   .data_license = options.license,
                                   .trained_on = TrainedOn(options, fold)};
}

// The windows of a fold do not depend on the seed: one file for all its models.
Status Begin(const Options& options, const Fold& fold) {
  POISE_ASSIGN_OR_RETURN(const prediction::PredictorTask task, Task(options, fold));
  for (int i = 0; i < options.seeds; ++i) {
    const uint64_t seed = options.first_seed + i;
    POISE_ASSIGN_OR_RETURN(const auto beginning, prediction::BeginPredictor(task, seed));
    const std::filesystem::path folder = FolderOf(options.begin, fold, seed);
    std::filesystem::create_directories(folder);
    POISE_RETURN_IF_ERROR(artifacts::WriteModelFolder(beginning.model, folder));
    std::ofstream(PathOf(options.begin, fold) + ".safetensors", std::ios::binary)
        << base::EncodeTensors(beginning.windows);
  }
  return absl::OkStatus();
}

StatusOr<artifacts::ModelArtifact> Learn(const Options& options, const Fold& fold, uint64_t seed) {
  POISE_ASSIGN_OR_RETURN(const prediction::PredictorTask task, Task(options, fold));
  const std::filesystem::path folder = FolderOf(options.save, fold, seed);
  base::RunContext context;
  context.seed = seed;
  context.progress = PrintProgress;
  context.cancellation = Stop();
  std::optional<bench::CheckpointFile> checkpoints;
  std::optional<std::string> checkpoint;
  learning::CheckpointSink sink;
  if (!options.save.empty()) {
    checkpoints.emplace(folder.string() + ".checkpoint");
    checkpoint = checkpoints->Read();
    sink = checkpoints->Sink(kCheckpointInterval);
  }
  POISE_ASSIGN_OR_RETURN(const prediction::PredictorResult trained,
                         prediction::TrainPredictor(task, context, checkpoint, sink));
  std::fprintf(stderr, "\n");
  const api::ModelCard& card = trained.model.card;
  const auto validation = card.scores.find("validation_rad");
  std::printf("trained %ld steps in %.0f s (%.1f ms each), best after %ld: validation %.4f\n",
              static_cast<long>(card.steps), trained.seconds,
              1e3 * trained.seconds / static_cast<double>(card.steps),
              static_cast<long>(trained.best_step),
              validation == card.scores.end() ? 0.0 : validation->second);
  if (!options.save.empty()) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder.string() + "_curve.csv") << trained.curve_csv;
    POISE_RETURN_IF_ERROR(artifacts::WriteModelFolder(trained.model, folder));
    checkpoints->Remove();
  }
  return trained.model;
}

Status LearnAndTest(const Options& options, const std::vector<Fold>& folds, uint64_t seed,
                    Results& results) {
  std::vector<artifacts::ModelArtifact> models;
  std::vector<PredictorPtr> predictors;
  for (const Fold& fold : folds) {
    const std::filesystem::path folder = FolderOf(options.save, fold, seed);
    const bool there = !options.save.empty() && std::filesystem::exists(folder / "card.json");
    POISE_ASSIGN_OR_RETURN(models.emplace_back(),
                           there ? artifacts::ReadModelFolder(folder) : Learn(options, fold, seed));
    POISE_ASSIGN_OR_RETURN(predictors.emplace_back(),
                           prediction::MakeTrainedPredictor(models.back()));
  }
  const std::string& family = models.front().card.family;
  POISE_ASSIGN_OR_RETURN(
      const std::vector<CardScores> scores,
      results.Test(predictors, {family, options.preset, seed}, options.protocols));
  for (size_t i = 0; !options.save.empty() && i < folds.size(); ++i) {
    for (const auto& [name, value] : scores[i]) models[i].card.scores[name] = value;
    POISE_RETURN_IF_ERROR(
        artifacts::WriteModelFolder(models[i], FolderOf(options.save, folds[i], seed)));
  }
  return absl::OkStatus();
}

Status Run(const Options& options) {
  POISE_ASSIGN_OR_RETURN(const std::vector<Fold> folds, LoadFolds(options));
  if (!options.begin.empty()) {
    for (const Fold& fold : folds) POISE_RETURN_IF_ERROR(Begin(options, fold));
    return absl::OkStatus();
  }
  Results results(folds);
  for (const std::string& name : prediction::BuiltInPredictorNames()) {
    const std::vector<PredictorPtr> floor(folds.size(), prediction::FindBuiltInPredictor(name));
    POISE_RETURN_IF_ERROR(results.Test(floor, {name + "@1", "", 0}, options.protocols).status());
  }
  for (const std::string& folder : options.models) {
    POISE_ASSIGN_OR_RETURN(const artifacts::ModelArtifact model,
                           artifacts::ReadModelFolder(folder));
    POISE_ASSIGN_OR_RETURN(const auto predictor, prediction::MakeTrainedPredictor(model));
    const std::string name = std::filesystem::path(folder).parent_path().filename().string();
    POISE_RETURN_IF_ERROR(results
                              .Test(std::vector<PredictorPtr>(folds.size(), predictor),
                                    {name, model.card.preset, model.card.seed}, options.protocols)
                              .status());
  }
  for (int i = 0; i < options.seeds; ++i) {
    POISE_RETURN_IF_ERROR(LearnAndTest(options, folds, options.first_seed + i, results));
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
  app.add_option("--left-out", options.left_out, "HDM05 actors that are the test; each in turn");
  app.add_option("--protocol", options.protocols, "seeded60, seeded75, all, loso");
  app.add_option("--model", options.models, "Folder of a trained model, tested too; repeatable")
      ->allow_extra_args(false);
  app.add_option("--seeds", options.seeds, "Trainings; 0: the floors alone");
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--out", options.out, "Results file (CSV)");
  app.add_option("--preset", options.preset, "As PredictorTraining has them")
      ->check(CLI::IsMember(poise::prediction::PredictorTraining::PresetNames()));
  app.add_option("--license", options.license, "Of the data, for the model's card");
  app.add_option("--save", options.save,
                 "Prefix for folders of models, for learning curves, and for where to go on");
  app.add_option("--begin", options.begin,
                 "Prefix for untrained models' folders, and for files with their windows");
  CLI11_PARSE(app, argc, argv);
  poise::Stop();  // made before a signal may come
  std::signal(SIGTERM, [](int) { poise::Stop().Cancel(); });
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
