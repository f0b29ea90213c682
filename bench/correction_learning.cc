#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/learning_setup.h"
#include "core/base/memory_policy.h"

/// What the effort `full` reaches on IK variants of one clip that training never saw, beside
/// `instant`, `fast` and the zero policy of the paper: CSV, one row per method; and the curve of
/// training.
///
///   correction_learning kick.amc --class kick --seed 1 --csv rows.csv --curve curve.csv
namespace poise::bench {
namespace {

using correction::CorrectionConfig;
using correction::Corrector;
using correction::ImitationLearner;
using correction::PolicyScore;
using correction::TrackingScore;

struct Options {
  LearningOptions learning;
  std::string curve, label = "full";
  int variants = 20;
  bool yardsticks = true, policy_only = false;
};

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
  Report(const Options& options, int frames)
      : options_(options),
        frames_(frames),
        file_(options.learning.csv,
              "clip,frames,class,method,seed,variants,completed,reward_normalised,reward_worst,"
              "force_mean_bw,force_peak_bw,force_peak_worst_bw,torque_mean_nm,torque_saturation,"
              "samples,training_s,correction_s_per_variant,commit") {}

  void Add(const std::string& method, const Mean& mean, int64_t samples, double training_s) {
    const double n = mean.variants;
    const LearningOptions& learning = options_.learning;
    file_.Add(fmt::format(
        "{},{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.5f},{},{:.1f},{:.3f},"
        "{}",
        std::filesystem::path(learning.clip).stem().string(), frames_, learning.action_class,
        method, learning.seed, mean.variants, mean.completed, mean.reward / n, mean.reward_worst,
        mean.force / n, mean.peak / n, mean.peak_worst, mean.torque / n, mean.saturation / n,
        samples, training_s, mean.seconds / n, learning.commit));
  }

 private:
  const Options& options_;
  int frames_;
  CsvFile file_;
};

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

void WriteCurve(const Options& options, const std::vector<PolicyScore>& curve) {
  CsvFile file(options.curve,
               "clip,method,seed,samples,variants,completed,reward_normalised,force_mean_bw,"
               "force_peak_bw,torque_mean_nm,merit,commit");
  const LearningOptions& learning = options.learning;
  for (const PolicyScore& score : curve) {
    file.Add(fmt::format("{},{},{},{},{},{},{:.4f},{:.4f},{:.4f},{:.2f},{:.4f},{}",
                         std::filesystem::path(learning.clip).stem().string(), options.label,
                         learning.seed, score.samples, score.variants, score.completed,
                         score.reward_normalised, score.residual_force_mean_bw,
                         score.residual_force_peak_bw, score.residual_torque_mean_nm, score.merit,
                         learning.commit));
  }
}

Corrector WithEffort(const LearningSetup& setup, const std::string& effort) {
  CorrectionConfig config = setup.correction;
  config.effort = effort;
  return Must(Corrector::Create(setup.clip, setup.roles, config));
}

int Run(const Options& options) {
  const LearningSetup setup = LearningSetup::From(options.learning);
  std::vector<motion::Clip> clips;
  for (int i = 0; i < options.variants; ++i) clips.push_back(Must(setup.test->Make(i, {})).clip);

  Report report(options, setup.clip.num_frames());
  if (options.yardsticks) {
    auto paper = Must(CorrectionConfig::FromPreset("paper"));
    paper.reward = setup.correction.reward;
    report.Add("paper_zero",
               Corrected(Must(Corrector::Create(setup.clip, setup.roles, paper)), clips), 0, 0);
    report.Add("instant", Corrected(WithEffort(setup, "instant"), clips), 0, 0);
    report.Add("fast", Corrected(WithEffort(setup, "fast"), clips), 0, 0);
  }
  const Corrector corrector = Must(Corrector::Create(setup.clip, setup.roles, setup.correction));
  ImitationLearner learner = Must(ImitationLearner::Create(corrector, setup.TrainingVariants(),
                                                           setup.imitation, options.learning.seed));
  const correction::TrainingReport trained = Must(learner.Train());
  if (!options.curve.empty()) WriteCurve(options, trained.curve);
  report.Add(options.label + "_policy", Imitated(corrector, learner, clips), trained.samples,
             trained.seconds);
  fmt::print(stderr, "best at {} samples; {}\n", trained.curve[trained.best].samples,
             trained.converged ? "converged" : "stopped by a limit");
  if (options.policy_only) return 0;
  const Mean full = Corrected(learner, clips);
  report.Add(options.label, full, trained.samples, trained.seconds);
  fmt::print(stderr, "policy chosen for {} of {}\n", full.chosen_full, full.variants);
  return 0;
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("Measures what a policy learns about one clip.", "correction_learning");
  options.learning.AddTo(app);
  app.add_option("--variants", options.variants, "that are tested");
  app.add_option("--curve", options.curve, "append the curve of training to this file");
  app.add_option("--label", options.label, "method's name in the rows");
  app.add_flag("--yardsticks,!--no-yardsticks", options.yardsticks,
               "also measure paper_zero, instant and fast");
  app.add_flag("--policy-only", options.policy_only,
               "measure the policy alone, without iterative learning on top of it");
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

}  // namespace
}  // namespace poise::bench

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();  // as poised does
  return poise::bench::Main(argc, argv);
}
