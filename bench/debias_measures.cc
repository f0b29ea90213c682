// What debiasing gives back of what imitation took, fold by fold: each actor's own clips are
// imitated, and debiased by a network that learned from the other actors' (and, beside it, by one
// that learned from all five, as MotionAug's authors do). "ceiling" is the original itself with its
// feet held where they were imitated:
//
//   debias_measures --data DIR/hdm05 --class kick --class jog --out debiasing.csv
//
// Prints means over the clips of each fold and of all folds; the results file has the columns of
// `poise evaluate`. Progress goes to standard error.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "core/base/memory_policy.h"
#include "core/correction/debias/debias_trainer.h"
#include "core/correction/debias/debiaser.h"
#include "core/correction/debias/foot_hold.h"
#include "core/motion/dataset/clip_folder.h"
#include "core/motion/metrics/euler_error.h"
#include "core/motion/metrics/plausibility.h"

namespace poise {
namespace {

using correction::DebiasPair;
using Measures = std::map<std::string, double>;

struct Options {
  std::string data, preset = "recommended", out;
  std::vector<std::string> classes = {"kick", "jog"};
  std::vector<std::string> corrections = {"instant", "paper_zero"};
  std::vector<std::string> assignments;
  uint64_t first_seed = 1;
  int seeds = 1;
  bool leaky = true;
};

double SecondsSince(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - time).count();
}

StatusOr<Measures> Measure(const motion::Clip& motion, const DebiasPair& pair) {
  const correction::PairError error = correction::ErrorBetween(motion, pair.original);
  POISE_ASSIGN_OR_RETURN(
      const std::vector<double> euler,
      motion::EulerErrors(
          motion::RotationVectors(pair.original, motion::RotationSense::kColumnVectors),
          motion::RotationVectors(motion, motion::RotationSense::kColumnVectors),
          motion::ColumnMask(3 * motion.num_joints(), true),
          motion::EulerErrorVariant::kAllColumns));
  POISE_ASSIGN_OR_RETURN(
      const motion::Plausibility plausibility,
      motion::AssessPlausibility(motion, pair.body->shapes(), /*floor_height_m=*/0));
  Measures measures = {{"joint_rad", error.joint_rad},
                       {"root_m", error.root_m},
                       {"foot_skate_mps", plausibility.foot_skate_mps},
                       {"penetration_mean_m", plausibility.penetration_mean_m},
                       {"penetration_max_m", plausibility.penetration_max_m},
                       {"jerk_rms_mps3", plausibility.jerk_rms_mps3},
                       {"euler_error_rad", 0}};
  for (const double frame : euler) {
    measures["euler_error_rad"] += frame / static_cast<double>(euler.size());
  }
  return measures;
}

class Table {
 public:
  explicit Table(const Options& options) : options_(options) {}

  Status Run() {
    for (const std::string& action_class : options_.classes) {
      POISE_ASSIGN_OR_RETURN(const motion::ClipSet set,
                             motion::ReadClipFolder(options_.data, {.action_class = action_class}));
      for (const std::string& correction : options_.corrections) {
        POISE_RETURN_IF_ERROR(Run(action_class, set.clips, correction));
      }
    }
    return absl::OkStatus();
  }

 private:
  StatusOr<correction::DebiasConfig> Config(const std::string& correction) const {
    POISE_ASSIGN_OR_RETURN(auto config, correction::DebiasConfig::FromPreset(options_.preset));
    config.effort = correction == "fast" ? "fast" : "instant";
    config.correction = correction == "paper_zero" ? "paper" : "recommended";
    base::Overrides overrides;
    for (const std::string& assignment : options_.assignments) {
      const size_t equals = std::min(assignment.find('='), assignment.size());
      overrides[assignment.substr(0, equals)] =
          assignment.substr(std::min(equals + 1, assignment.size()));
    }
    POISE_RETURN_IF_ERROR(base::ApplyOverrides(overrides, config.Fields()));
    return config;
  }

  Status Run(const std::string& action_class, const std::vector<motion::LabelledClip>& clips,
             const std::string& correction) {
    POISE_ASSIGN_OR_RETURN(const correction::DebiasConfig config, Config(correction));
    POISE_ASSIGN_OR_RETURN(const auto correcting, correction::CorrectionOf(config));
    std::map<std::string, std::vector<correction::DebiasClip>> by_actor;
    for (const motion::LabelledClip& clip : clips) {
      by_actor[clip.actor].push_back({clip.clip, clip.actor});
    }
    std::map<std::string, std::vector<DebiasPair>> pairs;
    for (const auto& [actor, originals] : by_actor) {
      POISE_ASSIGN_OR_RETURN(pairs[actor], correction::MakeDebiasPairs(originals, correcting, {}));
      fmt::print(stderr, "{} {} {}: {} of {} clips completed\n", action_class, correction, actor,
                 pairs[actor].size(), originals.size());
    }
    POISE_RETURN_IF_ERROR(Ceiling(action_class, correction, pairs, config));
    for (int i = 0; i < options_.seeds; ++i) {
      const uint64_t seed = options_.first_seed + i;
      for (const bool leaky : {false, true}) {
        if (leaky && !options_.leaky) continue;
        correction::DebiasConfig used = config;
        // As the authors': nothing is left out to choose by.
        used.choose_l2 = config.choose_l2 && !leaky;
        POISE_RETURN_IF_ERROR(Folds(action_class, correction, pairs, used, seed, leaky));
      }
    }
    return absl::OkStatus();
  }

  // What a debiaser that knew the originals could give back with these feet.
  Status Ceiling(const std::string& action_class, const std::string& correction,
                 const std::map<std::string, std::vector<DebiasPair>>& pairs,
                 const correction::DebiasConfig& config) {
    std::vector<std::pair<Measures, Measures>> all;
    for (const auto& [actor, some] : pairs) {
      for (const DebiasPair& pair : some) {
        const motion::Clip held =
            correction::HoldFeet(pair.original, pair.imitated, *pair.body, config.hold);
        POISE_ASSIGN_OR_RETURN(Measures before, Measure(pair.imitated, pair));
        POISE_ASSIGN_OR_RETURN(Measures after, Measure(held, pair));
        all.emplace_back(std::move(before), std::move(after));
      }
    }
    Summarise(action_class, correction + "_ceiling", "all", options_.first_seed, all);
    return absl::OkStatus();
  }

  Status Folds(const std::string& action_class, const std::string& correction,
               const std::map<std::string, std::vector<DebiasPair>>& pairs,
               const correction::DebiasConfig& config, uint64_t seed, bool leaky) {
    const std::string name = correction + (leaky ? "_leaky" : "");
    std::vector<std::pair<Measures, Measures>> all;
    for (const auto& [held_out, test] : pairs) {
      std::vector<DebiasPair> train;
      for (const auto& [actor, some] : pairs) {
        if (leaky || actor != held_out) train.insert(train.end(), some.begin(), some.end());
      }
      base::RunContext context;
      context.seed = seed;
      const auto began = std::chrono::steady_clock::now();
      POISE_ASSIGN_OR_RETURN(const auto result, correction::TrainDebias(
                                                    {.train = {}, .held_out = {}, .config = config},
                                                    train, {}, context));
      Row(action_class, name, held_out, seed, "training_s", SecondsSince(began));
      fmt::print(stderr, "{} {}: learned {:.1f} s, training clips {:.4f} > {:.4f} rad\n", name,
                 held_out, SecondsSince(began), result.model.card.scores.at("imitated_rad"),
                 result.model.card.scores.at("debiased_rad"));
      POISE_ASSIGN_OR_RETURN(const auto debiaser, correction::Debiaser::Create(result.model));
      std::vector<std::pair<Measures, Measures>> fold;
      for (const DebiasPair& pair : test) {
        POISE_ASSIGN_OR_RETURN(const motion::Clip debiased,
                               debiaser->Apply(pair.imitated, *pair.body));
        POISE_ASSIGN_OR_RETURN(Measures before, Measure(pair.imitated, pair));
        POISE_ASSIGN_OR_RETURN(Measures after, Measure(debiased, pair));
        fold.emplace_back(std::move(before), std::move(after));
      }
      Summarise(action_class, name, held_out, seed, fold);
      all.insert(all.end(), fold.begin(), fold.end());
    }
    Summarise(action_class, name, "all", seed, all);
    return absl::OkStatus();
  }

  // Means over clips.
  void Summarise(const std::string& action_class, const std::string& name, const std::string& fold,
                 uint64_t seed, const std::vector<std::pair<Measures, Measures>>& clips) {
    if (clips.empty()) return;
    fmt::print("{} {:18} {:4} seed {} {:3} clips", action_class, name, fold, seed, clips.size());
    for (const auto& [metric, unused] : clips.front().first) {
      double before = 0, after = 0;
      for (const auto& [imitated, debiased] : clips) {
        before += imitated.at(metric) / static_cast<double>(clips.size());
        after += debiased.at(metric) / static_cast<double>(clips.size());
      }
      fmt::print("  {} {:.4f} > {:.4f} ({:.2f})", metric, before, after, after / before);
      Row(action_class, name, fold, seed, "imitated_" + metric, before);
      Row(action_class, name, fold, seed, "debiased_" + metric, after);
    }
    fmt::print("\n");
    std::fflush(stdout);
  }

  void Row(const std::string& action_class, const std::string& name, const std::string& fold,
           uint64_t seed, const std::string& metric, double value) {
    if (options_.out.empty()) return;
    if (!results_.is_open()) {
      results_.open(options_.out);
      results_ << "task,model,preset,protocol,action,frame,horizon_ms,seed,metric,value\n";
    }
    results_ << fmt::format("debias,{},{},without {},{},,,{},{},{:.6g}\n", name, options_.preset,
                            fold, action_class, seed, metric, value)
             << std::flush;
  }

  const Options options_;
  std::ofstream results_;
};

}  // namespace
}  // namespace poise

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();
  poise::Options options;
  CLI::App app("Trains debiasing networks and measures what they give back.");
  app.add_option("--data", options.data, "Folder of clips")->required();
  app.add_option("--class", options.classes, "Of the clips; repeatable (default: kick and jog)");
  app.add_option("--correction", options.corrections, "instant, fast, paper_zero");
  app.add_option("--preset", options.preset, "recommended or paper");
  app.add_option("--set", options.assignments, "KEY=VALUE of the training; repeatable");
  app.add_option("--seeds", options.seeds, "Trainings of each network");
  app.add_option("--first-seed", options.first_seed);
  app.add_flag("!--no-leaky", options.leaky, "Leave out the networks that learn from all actors");
  app.add_option("--out", options.out, "Results file (CSV)");
  CLI11_PARSE(app, argc, argv);
  const poise::Status status = poise::Table(options).Run();
  if (status.ok()) return 0;
  std::fprintf(stderr, "error: %s\n", poise::base::Message(status).c_str());
  return 1;
}
