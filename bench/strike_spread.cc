#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "bench/learning_setup.h"
#include "core/base/memory_policy.h"
#include "core/correction/imitation/policy_rollout.h"
#include "core/correction/imitation/strike_environment.h"
#include "core/learning/rl/ppo.h"
#include "core/motion/kinematics/forward_kinematics.h"

/// Where a limb goes in augmented motions (MotionAug sec. 4.4, figure 10): CSV, one row per
/// variant. The same targets for all methods: those that the limb of an IK variant reaches at its
/// keyframe.
///
///   source   the clip itself
///   ik       the IK variants, before correction
///   ours     a policy imitates the IK variants (effort full, the policy alone)
///   strike   a policy imitates the clip and is rewarded for striking the targets
///
///   strike_spread kick.amc --method strike --set strike.weight=0.7 --csv rows.csv
/// draw_targets.py draws the rows.
namespace poise::bench {
namespace {

using correction::Corrector;
using correction::ImitationLearner;
using correction::ImitationSpaces;
using correction::MotionTracker;
using correction::Recording;
using correction::ReferenceMotion;
using correction::Strike;
using correction::StrikeConfig;
using correction::StrikeEnvironment;
using correction::TrackingScore;
using math::Vec3;

constexpr int kTrainingTargets = 512;

struct Options {
  LearningOptions learning;
  std::string method = "ours", label;
  int variants = 100;
  StrikeConfig strike;
};

/// What a limb is to reach, and the IK variant that does.
struct Target {
  ReferenceMotion variant;
  int body;
  Vec3 position;
};

Target TargetOf(const Corrector& corrector, const pipeline::AugmentFlow& flow, int ordinal) {
  const api::Variant variant = Must(flow.Make(ordinal, {}));
  ReferenceMotion reference = Must(corrector.Reference(variant.clip));
  const int body = static_cast<int>(variant.ik->end_effector);
  const Vec3 position = physics::ComputeFrames(corrector.model().articulation(),
                                               reference.source_frame(variant.ik->keyframe))
                            .positions[body];
  return {std::move(reference), body, position};
}

/// Where the limb went in one motion.
struct Reach {
  Vec3 extreme = Vec3::Zero();  ///< [m] where it is farthest from the pelvis, horizontally
  double miss_m = std::numeric_limits<double>::infinity();  ///< nearest to the target
};

Reach Measure(const motion::Clip& clip, int frames, const Target& target) {
  const motion::WorldPoses poses = motion::ForwardKinematics(clip);
  Reach reach;
  double farthest = -1;
  for (int frame = 0; frame < frames; ++frame) {
    const Vec3 limb = poses.position(frame, target.body);
    const Vec3 from_pelvis = limb - poses.position(frame, 0);
    const double distance = std::hypot(from_pelvis.x(), from_pelvis.z());
    if (distance > farthest) {
      farthest = distance;
      reach.extreme = limb;
    }
    reach.miss_m = std::min(reach.miss_m, (limb - target.position).norm());
  }
  return reach;
}

class Report {
 public:
  explicit Report(const Options& options)
      : options_(options),
        file_(options.learning.csv,
              "clip,method,seed,variant,completed,reward_normalised,force_mean_bw,torque_mean_nm,"
              "target_x,target_y,target_z,extreme_x,extreme_y,extreme_z,miss_m,samples,commit") {}

  /// Of a motion that nobody simulated the score is 0.
  void Add(int variant, const Target& target, const Reach& reach, const TrackingScore& score,
           int64_t samples) {
    const auto vector = [](const Vec3& v) {
      return fmt::format("{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z());
    };
    file_.Add(fmt::format("{},{},{},{},{:d},{:.4f},{:.4f},{:.2f},{},{},{:.4f},{},{}",
                          std::filesystem::path(options_.learning.clip).stem().string(),
                          options_.label.empty() ? options_.method : options_.label,
                          options_.learning.seed, variant, score.completed, score.reward_normalised,
                          score.residual_force_mean_bw, score.residual_torque_mean_nm,
                          vector(target.position), vector(reach.extreme), reach.miss_m, samples,
                          options_.learning.commit));
  }
  void Add(int variant, const Target& target, const Recording& recording, int64_t samples) {
    const int frames = std::max(
        1, static_cast<int>(std::lround(recording.score.completion * recording.clip.num_frames())));
    Add(variant, target, Measure(recording.clip, frames, target), recording.score, samples);
  }

 private:
  const Options& options_;
  CsvFile file_;
};

void Ours(const LearningSetup& setup, const Corrector& corrector,
          const std::vector<Target>& targets, uint64_t seed, Report& report) {
  ImitationLearner learner =
      Must(ImitationLearner::Create(corrector, setup.TrainingVariants(), setup.imitation, seed));
  const correction::TrainingReport trained = Must(learner.Train());
  for (size_t i = 0; i < targets.size(); ++i) {
    report.Add(static_cast<int>(i), targets[i], Must(learner.Imitate(targets[i].variant)),
               trained.samples);
  }
}

rl::Ppo LearnToStrike(const LearningSetup& setup, const Corrector& corrector,
                      const StrikeConfig& strike, uint64_t seed) {
  std::vector<Vec3> places;
  int body = 0;
  for (int i = 0; i < kTrainingTargets; ++i) {
    const Target target = TargetOf(corrector, *setup.training, i);
    body = target.body;
    places.push_back(target.position);
  }
  const auto targets = [places](uint64_t draw) { return places[draw % places.size()]; };
  std::vector<std::unique_ptr<rl::Environment>> environments;
  for (int i = 0; i < setup.imitation.environments; ++i) {
    environments.push_back(Must(
        StrikeEnvironment::Create(corrector, setup.clip, body, targets, setup.imitation, strike)));
  }
  rl::Ppo ppo = Must(rl::Ppo::Create(std::move(environments), setup.imitation.ppo, seed));
  while (ppo.samples() < setup.imitation.max_samples) {
    const rl::IterationReport iteration = Must(ppo.Iterate());
    if (iteration.iteration % 10 == 0) {
      fmt::print(stderr, "{} samples, reward {:.4f}\n", ppo.samples(), iteration.reward_mean);
    }
  }
  return ppo;
}

void Struck(const LearningSetup& setup, const Corrector& corrector,
            const std::vector<Target>& targets, const Options& options, Report& report) {
  const rl::Ppo ppo = LearnToStrike(setup, corrector, options.strike, options.learning.seed);
  const rl::Policy policy = ppo.policy();
  const ImitationSpaces spaces(corrector.shared_model(), corrector.config().tracking,
                               setup.imitation);
  const ReferenceMotion reference = Must(corrector.Reference(setup.clip));
  MotionTracker tracker = Must(corrector.Tracker(reference.frame_rate()));
  for (size_t i = 0; i < targets.size(); ++i) {
    Strike strike(options.strike, targets[i].body, targets[i].position);
    const auto recording = tracker.Track(
        reference, {},
        PolicyCommander(spaces, setup.imitation, reference, policy, strike.Extra(reference)));
    report.Add(static_cast<int>(i), targets[i], Must(recording), ppo.samples());
  }
}

int Run(Options options) {
  const LearningSetup setup =
      LearningSetup::From(options.learning, base::Nested("strike", options.strike.Fields()));
  const Corrector corrector = Must(Corrector::Create(setup.clip, setup.roles, setup.correction));
  std::vector<Target> targets;
  for (int i = 0; i < options.variants; ++i) {
    targets.push_back(TargetOf(corrector, *setup.test, i));
  }
  Report report(options);
  if (options.method == "source") {
    const ReferenceMotion source = Must(corrector.Reference(setup.clip));
    report.Add(0, targets[0], Measure(source.source_clip(), source.num_frames(), targets[0]), {},
               0);
  } else if (options.method == "ik") {
    for (int i = 0; i < options.variants; ++i) {
      const ReferenceMotion& variant = targets[i].variant;
      report.Add(i, targets[i], Measure(variant.source_clip(), variant.num_frames(), targets[i]),
                 {}, 0);
    }
  } else if (options.method == "ours") {
    Ours(setup, corrector, targets, options.learning.seed, report);
  } else {
    Struck(setup, corrector, targets, options, report);
  }
  return 0;
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("Measures where a limb goes in augmented motions.", "strike_spread");
  options.learning.AddTo(app);
  app.add_option("--method", options.method, "source | ik | ours | strike")
      ->check(CLI::IsMember({"source", "ik", "ours", "strike"}));
  app.add_option("--label", options.label, "method's name in the rows");
  app.add_option("--variants", options.variants, "that are tested")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return Run(options);
}

}  // namespace
}  // namespace poise::bench

int main(int argc, char** argv) {
  poise::base::KeepFreedMemory();  // as poised does
  return poise::bench::Main(argc, argv);
}
