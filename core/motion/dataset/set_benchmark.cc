#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>
#include <utility>

#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/dataset/column_statistics.h"
#include "core/motion/editing/cut.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/editing/resample.h"

namespace poise::motion {
namespace {

constexpr double kRateTolerance = 1e-3;  // relative: files round the time of a frame

bool InClass(const LabelledClip& clip, const BenchmarkRules& rules) {
  return rules.action_class.empty() || IsOfClass(clip.action, rules.action_class);
}

StatusOr<Clip> AtRate(Clip clip, double rate) {
  if (rate == 0) return clip;
  const double step = clip.frame_rate() / rate;
  if (std::abs(step - std::round(step)) > kRateTolerance * step) return Resample(clip, rate);
  POISE_ASSIGN_OR_RETURN(const Clip thinned, TakeEvery(clip, static_cast<int>(std::round(step))));
  const auto positions = thinned.root_positions();
  const auto rotations = thinned.rotations();
  return Clip::Create(clip.name(), clip.skeleton(), rate, {positions.begin(), positions.end()},
                      {rotations.begin(), rotations.end()});
}

StatusOr<Clip> OnBody(Clip clip, const BenchmarkForm& form) {
  if (form.body == "all") return clip;
  POISE_ASSIGN_OR_RETURN(const JointRoles roles, JointRoles::Detect(*clip.skeleton()));
  return ReduceToRoles(clip, roles, ReductionMode::kReference);
}

StatusOr<Clip> Prepare(Clip clip, const BenchmarkForm& form) {
  POISE_ASSIGN_OR_RETURN(Clip timed, AtRate(std::move(clip), form.frame_rate));
  return OnBody(std::move(timed), form);
}

// Whether a clip can be measured by the same columns as the first.
Status CheckAlike(const Clip& first, const Clip& clip) {
  const Skeleton &a = *first.skeleton(), &b = *clip.skeleton();
  bool joints = a.num_joints() == b.num_joints();
  for (int j = 0; joints && j < a.num_joints(); ++j) joints = a.joint(j).name == b.joint(j).name;
  if (!joints) {
    return base::FailedPrecondition(
        "MIXED_BODIES", "data",
        fmt::format("clips '{}' and '{}' have other joints: make a data set of one body (poise "
                    "data add --retarget-to)",
                    first.name(), clip.name()));
  }
  if (first.frame_rate() == clip.frame_rate()) return absl::OkStatus();
  return base::FailedPrecondition(
      "MIXED_RATES", "frame_rate",
      fmt::format("clip '{}' has {} frames a second, '{}' has {}: say at which rate to learn",
                  first.name(), first.frame_rate(), clip.name(), clip.frame_rate()));
}

Status NoClips(const std::vector<LabelledClip>& all, const BenchmarkRules& rules) {
  std::set<std::string> actions, actors;
  for (const LabelledClip& clip : all) {
    actions.insert(clip.action);
    if (InClass(clip, rules)) actors.insert(clip.actor);
  }
  if (actors.empty() && !rules.action_class.empty()) {
    return base::NotFound("NO_CLIPS", "action_class",
                          fmt::format("no clip is of class '{}'; actions: {}", rules.action_class,
                                      fmt::join(actions, ", ")));
  }
  return base::NotFound("NO_CLIPS", "hold_out",
                        fmt::format("holding out '{}' leaves no clips to learn from or none to "
                                    "test; actors: {}",
                                    rules.hold_out, fmt::join(actors, ", ")));
}

}  // namespace

std::vector<base::Field> BenchmarkForm::Fields() {
  return {base::Number("frame_rate", &frame_rate, 0, Clip::kMaxFrameRate),
          base::Text("body", &body, {"roles", "all"})};
}

StatusOr<BenchmarkClips> MakeBenchmark(std::vector<LabelledClip> clips,
                                       const BenchmarkRules& rules) {
  BenchmarkClips benchmark;
  const bool whole = rules.form.body == "all";
  if (whole) benchmark.sense = RotationSense::kRowVectors;
  benchmark.variant = whole ? EulerErrorVariant::kMovingColumns : EulerErrorVariant::kAllColumns;
  std::vector<PoseMatrix> rows;
  for (const LabelledClip& labelled : clips) {
    if (!InClass(labelled, rules)) continue;
    const bool test = !rules.hold_out.empty() && labelled.actor == rules.hold_out;
    // Before they are thinned out, as published (reference sec. 1.5).
    if (whole && !test) rows.push_back(RotationVectors(labelled.clip, benchmark.sense));
    StatusOr<Clip> clip = Prepare(labelled.clip, rules.form);
    if (!clip.ok()) {
      return base::Annotate(clip.status(), fmt::format("clip '{}'", labelled.clip.name()));
    }
    (test ? benchmark.test : benchmark.train)
        .push_back({labelled.action, labelled.actor, *std::move(clip)});
  }
  if (benchmark.train.empty() || (!rules.hold_out.empty() && benchmark.test.empty())) {
    return NoClips(clips, rules);
  }
  const Clip& first = benchmark.train.front().clip;
  for (const auto* part : {&benchmark.train, &benchmark.test}) {
    for (const LabelledClip& clip : *part) POISE_RETURN_IF_ERROR(CheckAlike(first, clip.clip));
  }
  if (whole) {
    benchmark.counts = ColumnStatistics::Of(rows).moving();
  } else {
    benchmark.counts.assign(3 * static_cast<size_t>(first.num_joints()), true);
  }
  return benchmark;
}

}  // namespace poise::motion
