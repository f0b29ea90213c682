#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "bench/measure_rate.h"
#include "core/base/memory_policy.h"
#include "core/correction/corrector.h"
#include "core/motion/io/clip_file.h"
#include "core/pipeline/augment.h"
#include "tests/support/broken_clips.h"

/// What an effort reaches on the HDM05 clips below POISE_DATA_DIR, by class and group of actors:
/// a table, and with --csv a row for each motion. The controller's constants were chosen on actors
/// bd and bk; dg, mm and tr are held out.
///
///   correction_measures --effort fast --input ik --csv rows.csv
namespace poise::bench {
namespace {

using correction::Correction;
using correction::CorrectionConfig;
using correction::Corrector;

struct ActionClass {
  const char* name;    // of the IK targets
  const char* folder;  // of the data
};
constexpr ActionClass kClasses[] = {
    {"kick", "kickLFront1Reps"},    {"jog", "jogLeftCircle4StepsRstart"},
    {"grab", "grabHighR"},          {"deposit", "depositFloorR"},
    {"sneak", "sneak2StepsLStart"}, {"throw", "throwBasketball"},
    {"hop", "hopBothLegs1hops"},
};

struct Options {
  std::string effort = "instant", preset = "recommended", input = "clean", csv, actors;
  std::vector<std::string> classes, overrides;
  int clips_per_group = 0;  // 0: all
  int variants = 4;
  uint64_t seed = 1;
};

/// A motion to correct, of a clip; named in the rows.
struct Input {
  std::string name;
  motion::Clip clip;
};

struct Sum {
  int motions = 0, completed = 0;
  double reward = 0, force = 0, peak = 0, torque = 0, seconds = 0;
  motion::Plausibility before, after;

  void Add(const Correction& correction) {
    completed += correction.score.completed;
    reward += correction.score.reward_normalised;
    force += correction.score.residual_force_mean_bw;
    peak += correction.score.residual_force_peak_bw;
    torque += correction.score.residual_torque_mean_nm;
    for (const auto& [sum, one] :
         {std::pair(&before, &correction.before), std::pair(&after, &correction.after)}) {
      sum->foot_skate_mps += one->foot_skate_mps;
      sum->penetration_mean_m += one->penetration_mean_m;
      sum->penetration_max_m += one->penetration_max_m;
      sum->float_mean_m += one->float_mean_m;
      sum->self_penetration_max_m += one->self_penetration_max_m;
    }
  }

  std::string Line(const std::string& name) const {
    const double n = std::max(motions, 1);
    return fmt::format(
        "{:16} {:3}/{:3}  {:.3f}  {:.3f} {:.2f} {:5.1f}  {:.3f} > {:.3f} ({:.2f})  {:6.2f} > "
        "{:.2f}, "
        "{:5.1f} > {:.1f}  {:5.1f} > {:4.1f}  {:5.1f} > {:4.1f}  {:6.0f}\n",
        name, completed, motions, reward / n, force / n, peak / n, torque / n,
        before.foot_skate_mps / n, after.foot_skate_mps / n,
        after.foot_skate_mps / std::max(before.foot_skate_mps, 1e-9),
        1e3 * before.penetration_mean_m / n, 1e3 * after.penetration_mean_m / n,
        1e3 * before.penetration_max_m / n, 1e3 * after.penetration_max_m / n,
        1e3 * before.float_mean_m / n, 1e3 * after.float_mean_m / n,
        1e3 * before.self_penetration_max_m / n, 1e3 * after.self_penetration_max_m / n,
        1e3 * seconds / n);
  }
};

template <typename T>
T Must(StatusOr<T> value) {
  if (value.ok()) return *std::move(value);
  fmt::print(stderr, "{}\n", base::Message(value.status()));
  std::exit(1);
}

CorrectionConfig Configure(const Options& options) {
  CorrectionConfig config = Must(CorrectionConfig::FromPreset(options.preset));
  config.effort = options.effort;
  base::Overrides overrides;
  for (const std::string& text : options.overrides) {
    const size_t equals = std::min(text.find('='), text.size());
    overrides[text.substr(0, equals)] = text.substr(std::min(equals + 1, text.size()));
  }
  const Status applied = base::ApplyOverrides(overrides, config.Fields());
  if (!applied.ok()) {
    fmt::print(stderr, "{}\n", base::Message(applied));
    std::exit(1);
  }
  return config;
}

// HDM_bd_kick...: the two letters after the first underscore.
std::string ActorOf(const std::filesystem::path& file) {
  return file.filename().string().substr(4, 2);
}

std::string GroupOf(const std::filesystem::path& file) {
  const std::string actor = ActorOf(file);
  return actor == "bd" || actor == "bk" ? "bd_bk" : "held_out";
}

std::vector<std::filesystem::path> Files(const Options& options, const std::string& folder) {
  const char* data = std::getenv("POISE_DATA_DIR");
  std::vector<std::filesystem::path> files;
  if (data == nullptr) return files;
  const std::filesystem::path path = std::filesystem::path(data) / "hdm05" / folder;
  if (!std::filesystem::exists(path)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.path().extension() == ".amc") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::map<std::string, int> taken;
  std::erase_if(files, [&](const std::filesystem::path& file) {
    if (options.actors.find(ActorOf(file)) == std::string::npos && !options.actors.empty()) {
      return true;
    }
    return options.clips_per_group > 0 && ++taken[GroupOf(file)] > options.clips_per_group;
  });
  return files;
}

std::vector<Input> MakeInputs(const Options& options, const char* action_class,
                              const motion::Clip& clip, const motion::JointRoles& roles) {
  if (options.input == "clean") return {{"clean", clip}};
  std::vector<Input> inputs;
  if (options.input == "broken") {
    for (const testing::Fault fault : testing::kFaults) {
      inputs.push_back(
          {std::string(testing::FaultName(fault)), testing::Break(clip, roles, fault)});
    }
    return inputs;
  }
  if (action_class == std::string("hop")) return {};  // has no IK targets
  api::AugmentSpec spec;
  spec.sources = {api::ClipSource{clip, {}}};
  spec.method = "ik";
  spec.action_class = action_class;
  spec.overrides["ik.propagation"] = "ramp";
  spec.variants_per_source = options.variants;
  spec.seed = options.seed;
  spec.with_plausibility = false;
  const auto flow = Must(pipeline::AugmentFlow::Create(spec, {{clip, roles}}));
  for (int i = 0; i < options.variants; ++i) {
    inputs.push_back({fmt::format("ik{}", i), Must(flow->Make(i, {})).clip});
  }
  return inputs;
}

void WriteRow(std::ofstream& csv, const std::string& clip, const Input& input,
              const StatusOr<Correction>& correction) {
  if (!correction.ok()) {
    csv << fmt::format("{},{},0,0,0,0,0,,,,,,,,\n", clip, input.name);
    return;
  }
  const correction::TrackingScore& score = correction->score;
  const motion::Plausibility &before = correction->before, &after = correction->after;
  csv << fmt::format(
      "{},{},{},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{:.4f},{:.6f},{:.6f},{:.5f},{:.5f},{:.5f},"
      "{:.5f}\n",
      clip, input.name, static_cast<int>(score.completed), score.reward_normalised,
      score.residual_force_mean_bw, score.residual_force_peak_bw, score.residual_torque_mean_nm,
      before.foot_skate_mps, after.foot_skate_mps, after.penetration_mean_m,
      after.penetration_max_m, before.float_mean_m, after.float_mean_m,
      before.self_penetration_max_m, after.self_penetration_max_m);
}

int Run(const Options& options) {
  const CorrectionConfig config = Configure(options);
  std::ofstream csv(options.csv);
  csv << "clip,input,completed,reward_normalised,force_mean_bw,force_peak_bw,torque_mean_nm,"
         "skating_before_mps,skating_after_mps,penetration_mean_m,penetration_max_m,float_before_m,"
         "float_after_m,self_penetration_before_m,self_penetration_after_m\n";
  std::map<std::string, Sum> inputs;  // of all classes
  Sum all;
  fmt::print(
      "                 completed reward  force, peak torque  skating [m/s]            penetration "
      "mean, max [mm]    float [mm]     overlap [mm]   ms\n");
  for (const ActionClass& action_class : kClasses) {
    if (!options.classes.empty() &&
        std::ranges::find(options.classes, action_class.name) == options.classes.end()) {
      continue;
    }
    std::map<std::string, Sum> groups;
    for (const std::filesystem::path& path : Files(options, action_class.folder)) {
      const motion::Clip clip = Must(motion::ReadClipFile(path)).clip;
      const motion::JointRoles roles = Must(motion::JointRoles::Detect(*clip.skeleton()));
      for (const Input& input : MakeInputs(options, action_class.name, clip, roles)) {
        const double start = ThreadSeconds();
        // The character of broken clips is made of them: nobody has the sound ones.
        const Corrector corrector =
            Must(Corrector::Create(options.input == "broken" ? input.clip : clip, roles, config));
        const StatusOr<Correction> correction = corrector.Correct(input.clip);
        const double seconds = ThreadSeconds() - start;
        for (Sum* sum : {&groups[GroupOf(path)], &inputs[input.name], &all}) {
          ++sum->motions;
          sum->seconds += seconds;
          if (correction.ok()) sum->Add(*correction);
        }
        WriteRow(csv, path.stem(), input, correction);
      }
    }
    for (const auto& [name, sum] : groups) {
      fmt::print("{}", sum.Line(fmt::format("{} {}", action_class.name, name)));
      std::fflush(stdout);
    }
  }
  if (options.input == "broken") {
    for (const auto& [name, sum] : inputs) fmt::print("{}", sum.Line(name));
  }
  fmt::print("{}", all.Line("all"));
  return 0;
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("Measures what physical correction reaches.", "correction_measures");
  app.add_option("--effort", options.effort, "instant | fast");
  app.add_option("--preset", options.preset, "recommended | paper");
  app.add_option("--input", options.input, "clean | ik (variants, ramp over the clip) | broken");
  app.add_option("--class", options.classes, "kick, jog, ...; all unless given");
  app.add_option("--actors", options.actors, "such as bd,bk; all unless given");
  app.add_option("--clips", options.clips_per_group, "of each class and group of actors, at most");
  app.add_option("--variants", options.variants, "IK variants of each clip");
  app.add_option("--seed", options.seed, "of the variants");
  app.add_option("--set", options.overrides, "KEY=VALUE of the correction");
  app.add_option("--csv", options.csv, "write a row for each motion");
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

}  // namespace
}  // namespace poise::bench

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();  // as poised does
  return poise::bench::Main(argc, argv);
}
