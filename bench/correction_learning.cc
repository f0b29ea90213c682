#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/memory_policy.h"
#include "core/base/random.h"
#include "core/correction/imitation/imitation_learner.h"
#include "core/motion/io/clip_file.h"
#include "core/pipeline/augment.h"

/// What the effort `full` reaches on IK variants of one clip that training never saw, beside
/// `instant`, `fast` and the zero policy of the paper: CSV, one row per method; and the curve of
/// training.
///
///   correction_learning kick.amc --class kick --seed 1 --csv rows.csv --curve curve.csv
namespace poise::bench {
namespace {

using correction::Correction;
using correction::CorrectionConfig;
using correction::Corrector;
using correction::ImitationConfig;
using correction::ImitationLearner;
using correction::ReferenceMotion;
using correction::TrackingScore;

struct Options {
  std::string clip, action_class = "kick", csv, curve, commit = "unknown", label = "full";
  std::string preset = "recommended";
  uint64_t seed = 1;
  int variants = 20;
  bool yardsticks = true;
  std::vector<std::string> overrides;  // "ppo.noise=0.05", "correction.tracking.residual_factor=1"
};

constexpr uint64_t kTestStream = 1, kTrainingStream = 2;

struct Mean {
  int variants = 0, completed = 0;
  double reward = 0, reward_worst = 1, force = 0, peak = 0, peak_worst = 0, torque = 0;
  double saturation = 0, skating = 0;
  int chosen_full = 0;
  double seconds = 0;

  void Add(const TrackingScore& score) {
    ++variants;
    completed += score.completed;
    reward += score.reward_normalised;
    reward_worst = std::min(reward_worst, score.reward_normalised);
    force += score.residual_force_mean_bw;
    peak += score.residual_force_peak_bw;
    peak_worst = std::max(peak_worst, score.residual_force_peak_bw);
    torque += score.residual_torque_mean_nm;
    saturation += score.torque_saturation;
  }
};

class Report {
 public:
  Report(const Options& options, int frames) : options_(options), frames_(frames) {
    std::ifstream old(options.csv);
    const bool fresh = !old.good() || old.peek() == std::ifstream::traits_type::eof();
    if (!options.csv.empty()) file_.open(options.csv, std::ios::app);
    const std::string head =
        "clip,frames,class,method,seed,variants,completed,reward_normalised,reward_worst,"
        "force_mean_bw,force_peak_bw,force_peak_worst_bw,torque_mean_nm,torque_saturation,samples,"
        "training_s,correction_s_per_variant,commit\n";
    if (fresh) file_ << head;
    fmt::print("{}", head);
  }

  void Add(const std::string& method, const Mean& mean, int64_t samples, double training_s) {
    const double n = mean.variants;
    const std::string clip = std::filesystem::path(options_.clip).stem();
    const std::string row = fmt::format(
        "{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.5f},{},{:.1f},{:.3f},"
        "{}\n",
        clip, frames_, options_.action_class, method, options_.seed, mean.variants, mean.completed,
        mean.reward / n, mean.reward_worst, mean.force / n, mean.peak / n, mean.peak_worst,
        mean.torque / n, mean.saturation / n, samples, training_s, mean.seconds / n,
        options_.commit);
    file_ << row << std::flush;
    fmt::print("{}", row);
    std::fflush(stdout);
  }

 private:
  const Options& options_;
  int frames_;
  std::ofstream file_;
};

template <typename T>
T Must(StatusOr<T> value) {
  if (value.ok()) return *std::move(value);
  fmt::print(stderr, "{}\n", base::Message(value.status()));
  std::exit(1);
}

void Must(const Status& status) {
  if (status.ok()) return;
  fmt::print(stderr, "{}\n", base::Message(status));
  std::exit(1);
}

std::unique_ptr<pipeline::AugmentFlow> Variants(const Options& options, const motion::Clip& clip,
                                                const motion::JointRoles& roles, uint64_t stream) {
  api::AugmentSpec spec;
  spec.sources = {api::ClipSource{clip, {}}};
  spec.method = "ik";
  spec.action_class = options.action_class;
  spec.variants_per_source = static_cast<int>(correction::kVariantDraws);
  spec.seed = base::DeriveSeed(options.seed, {stream});
  spec.with_plausibility = false;
  return Must(pipeline::AugmentFlow::Create(spec, {{clip, roles}}));
}

// Seconds that `work` takes.
template <typename Work>
double Time(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Mean Corrected(const Corrector& corrector, const std::vector<motion::Clip>& clips) {
  Mean mean;
  mean.seconds = Time([&] {
    for (const motion::Clip& clip : clips) {
      const auto correction = corrector.Correct(clip);
      mean.Add(correction.ok() ? correction->score : TrackingScore());
    }
  });
  return mean;
}

Mean Imitated(const Corrector& corrector, const ImitationLearner& learner,
              const std::vector<motion::Clip>& clips) {
  Mean mean;
  mean.seconds = Time([&] {
    for (const motion::Clip& clip : clips) {
      const auto recording = learner.Imitate(Must(corrector.Reference(clip)));
      mean.Add(recording.ok() ? recording->score : TrackingScore());
    }
  });
  return mean;
}

Mean Corrected(const ImitationLearner& learner, const std::vector<motion::Clip>& clips) {
  Mean mean;
  mean.seconds = Time([&] {
    for (const motion::Clip& clip : clips) {
      const auto correction = learner.Correct(clip);
      mean.Add(correction.ok() ? correction->score : TrackingScore());
      mean.chosen_full += correction.ok() && correction->effort == "full";
    }
  });
  return mean;
}

void WriteCurve(const Options& options, const correction::TrainingReport& report) {
  std::ifstream old(options.curve);
  const bool fresh = !old.good() || old.peek() == std::ifstream::traits_type::eof();
  std::ofstream out(options.curve, std::ios::app);
  if (fresh) {
    out << "clip,method,seed,samples,variants,completed,reward_normalised,force_mean_bw,"
           "force_peak_bw,torque_mean_nm,merit,commit\n";
  }
  for (const correction::PolicyScore& score : report.curve) {
    out << fmt::format("{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{}\n",
                       std::filesystem::path(options.clip).stem().string(), options.label,
                       options.seed, score.samples, score.variants, score.completed,
                       score.reward_normalised, score.residual_force_mean_bw,
                       score.residual_force_peak_bw, score.residual_torque_mean_nm, score.merit,
                       options.commit);
  }
}

void Configure(const Options& options, CorrectionConfig& correction, ImitationConfig& imitation) {
  correction = Must(CorrectionConfig::FromPreset(options.preset));
  imitation = Must(ImitationConfig::FromPreset(options.preset));
  std::vector<base::Field> fields = imitation.Fields();
  base::Append(fields, base::Nested("correction", correction.Fields()));
  base::Overrides overrides;
  for (const std::string& text : options.overrides) {
    const size_t equals = text.find('=');
    overrides[text.substr(0, equals)] = text.substr(std::min(equals, text.size() - 1) + 1);
  }
  Must(base::ApplyOverrides(overrides, fields));
}

int Run(const Options& options) {
  const motion::Clip clip = Must(motion::ReadClipFile(options.clip)).clip;
  const motion::JointRoles roles = Must(motion::JointRoles::Detect(*clip.skeleton()));
  CorrectionConfig config;
  ImitationConfig imitation;
  Configure(options, config, imitation);
  const auto test = Variants(options, clip, roles, kTestStream);
  const auto training = Variants(options, clip, roles, kTrainingStream);
  std::vector<motion::Clip> clips;
  for (int i = 0; i < options.variants; ++i) clips.push_back(Must(test->Make(i, {})).clip);

  Report report(options, clip.num_frames());
  if (options.yardsticks) {
    CorrectionConfig instant = config, fast = config;
    instant.effort = "instant";
    fast.effort = "fast";
    const CorrectionConfig paper = Must(CorrectionConfig::FromPreset("paper"));
    report.Add("paper_zero", Corrected(Must(Corrector::Create(clip, roles, paper)), clips), 0, 0);
    report.Add("instant", Corrected(Must(Corrector::Create(clip, roles, instant)), clips), 0, 0);
    report.Add("fast", Corrected(Must(Corrector::Create(clip, roles, fast)), clips), 0, 0);
  }
  const Corrector corrector = Must(Corrector::Create(clip, roles, config));
  ImitationLearner learner = Must(ImitationLearner::Create(
      corrector,
      [&](uint64_t draw) -> StatusOr<motion::Clip> {
        POISE_ASSIGN_OR_RETURN(api::Variant variant,
                               training->Make(static_cast<int64_t>(draw), {}));
        return std::move(variant.clip);
      },
      imitation, options.seed));
  const correction::TrainingReport trained = Must(learner.Train());
  if (!options.curve.empty()) WriteCurve(options, trained);
  report.Add(options.label + "_policy", Imitated(corrector, learner, clips), trained.samples,
             trained.seconds);
  const Mean full = Corrected(learner, clips);
  report.Add(options.label, full, trained.samples, trained.seconds);
  fmt::print(stderr, "policy chosen for {} of {}; best at {} samples; {}\n", full.chosen_full,
             full.variants, trained.curve[trained.best].samples,
             trained.converged ? "converged" : "stopped by a limit");
  return 0;
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("Measures what a policy learns about one clip.", "correction_learning");
  app.add_option("clip", options.clip, "motion file")->required();
  app.add_option("--class", options.action_class, "preset of the IK targets");
  app.add_option("--seed", options.seed, "of the variants and of training");
  app.add_option("--variants", options.variants, "that are tested");
  app.add_option("--preset", options.preset, "recommended | paper");
  app.add_option("--set", options.overrides, "KEY=VALUE of the imitation, or correction.KEY");
  app.add_option("--csv", options.csv, "append the rows to this file");
  app.add_option("--curve", options.curve, "append the curve of training to this file");
  app.add_option("--commit", options.commit, "written into each row");
  app.add_option("--label", options.label, "method's name in the rows");
  app.add_flag("--yardsticks,!--no-yardsticks", options.yardsticks,
               "also measure paper_zero, instant and fast");
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

}  // namespace
}  // namespace poise::bench

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();  // as poised does
  return poise::bench::Main(argc, argv);
}
