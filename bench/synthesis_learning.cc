// Re-makes table 1 of MotionAug: trains a GAN and the VAE with and without adversaries on one
// class, without one actor at a time, and measures what they make, by which sampling, beside the
// clips that they learned from:
//
//   synthesis_learning --data DIR/hdm05 --class kick --save models/kick --out kick.csv --seeds 3
//   synthesis_learning --data DIR/hdm05 --class kick --left-out bd --rows both
//
// A network that was saved is not trained again, so an interrupted run goes on. The results file
// has the columns of `poise evaluate`; the MMD of all folds together has the fold "pooled".
// Progress goes to standard error.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "CLI/CLI.hpp"
#include "bench/overrides.h"
#include "core/artifacts/model_artifact.h"
#include "core/base/memory_policy.h"
#include "core/motion/dataset/clip_folder.h"
#include "core/motion/distribution/compare_sets.h"
#include "core/motion/editing/reduce.h"
#include "core/synthesis/vae/vae_model.h"
#include "core/synthesis/vae/vae_motions.h"
#include "core/synthesis/vae/vae_trainer.h"

namespace poise {
namespace {

using Features = std::vector<motion::MotionFeatures>;

struct Options {
  std::string data;
  std::string action_class;
  std::vector<std::string> left_out;  // empty: each actor in turn
  std::vector<std::string> rows = {"training", "gan", "vae", "adversarial", "near", "both"};
  std::string preset = "recommended";
  std::vector<std::string> assignments;
  uint64_t first_seed = 1;
  int seeds = 1;
  int samples = 100;
  std::string save;  // prefix of the models' files
  std::string out;
  bool lengths = false;
};

// A line of the table: which network, trained with which settings, sampled how. "training": none.
struct Row {
  const char* name;
  const char* network;
  base::Overrides settings;
  const char* sampling;
};

const std::vector<Row>& TableRows() {
  static const std::vector<Row> rows = {
      {"training", "", {}, ""},
      // Rates and momentum as the discriminators': a faster generator runs away from them.
      {"gan",
       "gan",
       {{"generator", "gan"},
        {"vae_optimizer.learning_rate", "0.0001"},
        {"vae_optimizer.beta1", "0.5"}},
       "prior"},
      {"vae", "plain", {{"adversarial", "false"}}, "prior"},
      {"adversarial", "adversarial", {}, "prior"},
      {"near", "plain", {{"adversarial", "false"}}, "near"},
      {"both", "adversarial", {}, "near"},
  };
  return rows;
}

StatusOr<synthesis::VaeConfig> Config(const Options& options, const Row& row) {
  POISE_ASSIGN_OR_RETURN(synthesis::VaeConfig config,
                         synthesis::VaeConfig::FromPreset(options.preset));
  base::Overrides overrides = bench::ToOverrides(options.assignments);
  overrides.insert(row.settings.begin(), row.settings.end());
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

double SecondsSince(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

StatusOr<motion::MotionFeatures> Describe(const motion::Clip& clip) {
  POISE_ASSIGN_OR_RETURN(const auto roles, motion::JointRoles::Detect(*clip.skeleton()));
  return motion::DescribeMotion(clip, roles);
}

/// The clips of the class, and what was measured of them.
class Table {
 public:
  static StatusOr<Table> Create(const Options& options) {
    POISE_ASSIGN_OR_RETURN(
        motion::ClipSet set,
        motion::ReadClipFolder(options.data, {.action_class = options.action_class}));
    Table table(options, std::move(set.clips));
    for (const motion::LabelledClip& labelled : table.clips_) {
      POISE_ASSIGN_OR_RETURN(table.features_.emplace_back(), Describe(labelled.clip));
    }
    return table;
  }

  Status Run() {
    for (int i = 0; i < options_.seeds; ++i) {
      for (const Row& row : TableRows()) {
        if (std::find(options_.rows.begin(), options_.rows.end(), row.name) !=
            options_.rows.end()) {
          POISE_RETURN_IF_ERROR(Measure(row, options_.first_seed + i));
        }
      }
    }
    return absl::OkStatus();
  }

  Status PrintLengths() const {
    synthesis::VaeConfig config;
    POISE_ASSIGN_OR_RETURN(const synthesis::Fold fold,
                           synthesis::PrepareFold(clips_, {options_.action_class, Actors().front()},
                                                  config.frame_rate));
    std::vector<long> lengths;
    for (const auto& motion : fold.train) lengths.push_back(motion.phases.front().rows());
    fmt::print("{}\n", fmt::join(lengths, ","));
    return absl::OkStatus();
  }

 private:
  Table(const Options& options, std::vector<motion::LabelledClip> clips)
      : options_(options), clips_(std::move(clips)) {}

  std::vector<std::string> Actors() const {
    if (!options_.left_out.empty()) return options_.left_out;
    std::set<std::string> actors;
    for (const motion::LabelledClip& labelled : clips_) actors.insert(labelled.actor);
    return {actors.begin(), actors.end()};
  }

  Status Measure(const Row& row, uint64_t seed) {
    std::vector<motion::SamplePair> folds;
    base::Random random(seed);
    for (const std::string& actor : Actors()) {
      motion::MotionSets sets;
      for (size_t i = 0; i < clips_.size(); ++i) {
        (clips_[i].actor == actor ? sets.reference : sets.training).push_back(features_[i]);
      }
      if (*row.network == '\0') {
        sets.made = sets.training;
      } else {
        POISE_ASSIGN_OR_RETURN(const auto model, Network(row, actor, seed));
        POISE_ASSIGN_OR_RETURN(sets.made, MakeMotions(model, row, actor, seed));
      }
      base::RunContext context;
      context.seed = seed;
      POISE_ASSIGN_OR_RETURN(motion::SetComparison comparison,
                             motion::CompareSets(sets, {}, context));
      const base::Json measures = base::FieldsToJson(comparison.Fields());
      for (const auto& [name, value] : measures.items()) {
        Report(row, actor, seed, name, value.get<double>());
      }
      folds.push_back(motion::DescriptorPair(sets.made, sets.reference));
    }
    if (folds.size() < 2) return absl::OkStatus();
    POISE_ASSIGN_OR_RETURN(const motion::MmdResult pooled,
                           motion::MaximumMeanDiscrepancy(folds, {}, random));
    Report(row, "pooled", seed, "mmd", pooled.squared_mmd);
    Report(row, "pooled", seed, "mmd_p", pooled.p_value);
    return absl::OkStatus();
  }

  StatusOr<artifacts::ModelArtifact> Network(const Row& row, const std::string& actor,
                                             uint64_t seed) {
    const std::string prefix = fmt::format("{}-{}-{}-{}", options_.save, row.network, actor, seed);
    const std::string file = prefix + ".safetensors";
    if (!options_.save.empty() && std::filesystem::exists(file)) {
      std::ostringstream bytes;
      bytes << std::ifstream(file, std::ios::binary).rdbuf();
      return artifacts::UnpackModel(std::move(bytes).str(), file);
    }
    synthesis::VaeTask task;
    POISE_ASSIGN_OR_RETURN(task.config, Config(options_, row));
    task.clips = clips_;
    task.fold = {.action_class = options_.action_class, .held_out = actor};
    task.preset = options_.preset;
    base::RunContext context;
    context.seed = seed;
    context.progress = PrintProgress;
    const auto began = std::chrono::steady_clock::now();
    POISE_ASSIGN_OR_RETURN(synthesis::VaeResult result, synthesis::TrainVae(task, context));
    Report(row, actor, seed, "training_s", SecondsSince(began));
    for (const auto& [name, value] : result.model.card.scores) {
      Report(row, actor, seed, name, value);
    }
    if (!options_.save.empty()) {
      std::ofstream(prefix + "_curve.csv") << result.curve_csv;
      std::ofstream(prefix + "_latents.svg") << result.latent_map_svg;
      std::ofstream(file, std::ios::binary) << artifacts::PackModel(result.model);
    }
    return std::move(result.model);
  }

  StatusOr<Features> MakeMotions(const artifacts::ModelArtifact& artifact, const Row& row,
                                 const std::string& actor, uint64_t seed) {
    POISE_ASSIGN_OR_RETURN(const auto model, synthesis::VaeModel::Create(artifact));
    POISE_ASSIGN_OR_RETURN(const auto roles, motion::ReducedRoles(*model->skeleton()));
    const synthesis::LatentSampler sampler = model->MakeSampler({.mode = row.sampling});
    base::Random random(seed);
    std::vector<motion::Clip> clips;
    const auto began = std::chrono::steady_clock::now();
    for (int i = 0; i < options_.samples; ++i) {
      POISE_ASSIGN_OR_RETURN(motion::Clip clip, model->Decode(sampler.Draw(random), "made"));
      clips.push_back(std::move(clip));
    }
    Report(row, actor, seed, "samples_per_s", options_.samples / SecondsSince(began));
    Features features;
    for (const motion::Clip& clip : clips) {
      POISE_ASSIGN_OR_RETURN(features.emplace_back(), motion::DescribeMotion(clip, roles));
    }
    return features;
  }

  void Report(const Row& row, const std::string& fold, uint64_t seed, const std::string& metric,
              double value) {
    std::printf("%-12s %-7s seed %d  %-28s %.4f\n", row.name, fold.c_str(), static_cast<int>(seed),
                metric.c_str(), value);
    std::fflush(stdout);
    if (options_.out.empty()) return;
    if (!results_.is_open()) {
      results_.open(options_.out);
      results_ << "task,model,preset,protocol,action,frame,horizon_ms,seed,metric,value\n";
    }
    results_ << fmt::format("synthesis,{},{},without {},{},,,{},{},{:.6g}\n", row.name,
                            options_.preset, fold, options_.action_class, seed, metric, value)
             << std::flush;
  }

  const Options options_;
  const std::vector<motion::LabelledClip> clips_;
  Features features_;  // of clips_
  std::ofstream results_;
};

Status Run(const Options& options) {
  if (const auto folder = std::filesystem::path(options.save).parent_path(); !folder.empty()) {
    std::filesystem::create_directories(folder);
  }
  POISE_ASSIGN_OR_RETURN(Table table, Table::Create(options));
  return options.lengths ? table.PrintLengths() : table.Run();
}

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();
  poise::Options options;
  CLI::App app("Trains generators of motions and measures what they make.");
  app.add_option("--data", options.data, "Folder of clips")->required();
  app.add_option("--class", options.action_class, "Of the clips")->required();
  app.add_option("--left-out", options.left_out, "Actors; default: each in turn");
  app.add_option("--rows", options.rows, "training, gan, vae, adversarial, near, both");
  app.add_option("--preset", options.preset, "recommended or paper");
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--seeds", options.seeds, "Trainings of each network");
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--samples", options.samples, "Motions that each network makes");
  app.add_option("--save", options.save, "Prefix for models, learning curves and latent maps");
  app.add_option("--out", options.out, "Results file (CSV)");
  app.add_flag("--lengths", options.lengths, "Print the lengths of the training motions and end");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Run(options);
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
