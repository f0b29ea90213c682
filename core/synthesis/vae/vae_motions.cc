#include "core/synthesis/vae/vae_motions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/motion/editing/align.h"
#include "core/motion/editing/cut.h"
#include "core/motion/editing/reduce.h"
#include "core/motion/editing/resample.h"
#include "core/motion/joint_roles.h"

namespace poise::synthesis {
namespace {

using motion::Clip;
using motion::PoseMatrix;
using motion::Vec3;

constexpr motion::RotationCodec kCodec{.representation = motion::RotationRepresentation::kSixD};
constexpr double kRateTolerance = 1e-3;      // of whole multiples, relative
constexpr double kAuthorsUnit = 0.05;        // [m] of a BVH unit of MotionAug
constexpr double kSmallestDeviation = 1e-3;  // [m] an axis that does not move is left in metres

StatusOr<Clip> OnSixteenJoints(const Clip& clip) {
  POISE_ASSIGN_OR_RETURN(const motion::JointRoles roles,
                         motion::JointRoles::Detect(*clip.skeleton()));
  POISE_ASSIGN_OR_RETURN(const Clip aligned, motion::Align(clip, roles));
  return motion::ReduceToRoles(aligned, roles, motion::ReductionMode::kComposed);
}

StatusOr<std::vector<PoseMatrix>> Phases(const Clip& clip, double frame_rate) {
  std::vector<PoseMatrix> phases;
  const int step = static_cast<int>(std::lround(clip.frame_rate() / frame_rate));
  const bool whole =
      step >= 1 && std::abs(clip.frame_rate() / step - frame_rate) <= kRateTolerance * frame_rate;
  if (!whole) {
    POISE_ASSIGN_OR_RETURN(const Clip resampled, motion::Resample(clip, frame_rate));
    phases.push_back(EncodePoses(resampled, kCodec));
    return phases;
  }
  for (int phase = 0; phase < std::min(step, clip.num_frames()); ++phase) {
    POISE_ASSIGN_OR_RETURN(const Clip rest, motion::Cut(clip, phase, clip.num_frames() - phase));
    POISE_ASSIGN_OR_RETURN(const Clip thinned, motion::TakeEvery(rest, step));
    phases.push_back(EncodePoses(thinned, kCodec));
  }
  return phases;
}

base::Json VectorJson(const Vec3& v) { return base::Json::array({v.x(), v.y(), v.z()}); }

Vec3 VectorFrom(const base::Json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

Status NoClips(const FoldChoice& choice, const std::set<std::string>& actions,
               const std::set<std::string>& actors) {
  if (actors.empty()) {
    return base::FailedPrecondition(
        "NO_CLIPS", "action_class",
        fmt::format("the data set has no clips of class '{}'; its actions: {}", choice.action_class,
                    fmt::join(actions, ", ")));
  }
  return base::FailedPrecondition(
      "NO_CLIPS", "hold_out",
      fmt::format("holding out '{}' leaves nothing to learn from, or is none of the actors: {}",
                  choice.held_out, fmt::join(actors, ", ")));
}

}  // namespace

base::Json RootScale::ToJson() const {
  return {{"mean", VectorJson(mean)}, {"scale", VectorJson(scale)}};
}

StatusOr<RootScale> RootScale::FromJson(const base::Json& json) {
  try {
    return RootScale{VectorFrom(json.at("mean")), VectorFrom(json.at("scale"))};
  } catch (const base::Json::exception&) {
    return base::InvalidArgument("MALFORMED_CARD", "normalisation",
                                 "the root's normalisation needs mean and scale");
  }
}

StatusOr<PreparedMotion> PrepareMotion(const Clip& clip, double frame_rate) {
  const auto named = [&](const Status& status) {
    return base::Annotate(status, fmt::format("clip '{}'", clip.name()));
  };
  const StatusOr<Clip> reduced = OnSixteenJoints(clip);
  if (!reduced.ok()) return named(reduced.status());
  StatusOr<std::vector<PoseMatrix>> phases = Phases(*reduced, frame_rate);
  if (!phases.ok()) return named(phases.status());
  return PreparedMotion{*std::move(phases), reduced->skeleton()};
}

StatusOr<Fold> PrepareFold(const std::vector<motion::LabelledClip>& clips, const FoldChoice& choice,
                           double frame_rate) {
  Fold fold;
  std::set<std::string> actions, actors;
  for (const motion::LabelledClip& labelled : clips) {
    actions.insert(labelled.action);
    const bool wanted =
        choice.action_class.empty() || motion::IsOfClass(labelled.action, choice.action_class);
    if (!wanted) continue;
    actors.insert(labelled.actor);
    POISE_ASSIGN_OR_RETURN(PreparedMotion motion, PrepareMotion(labelled.clip, frame_rate));
    const bool held_out = !choice.held_out.empty() && labelled.actor == choice.held_out;
    (held_out ? fold.held_out : fold.train).push_back(std::move(motion));
  }
  if (fold.train.empty() || (!choice.held_out.empty() && fold.held_out.empty())) {
    return NoClips(choice, actions, actors);
  }
  actors.erase(choice.held_out);
  fold.description = fmt::format(
      "{}, actors {}{}", choice.action_class.empty() ? "all" : "class " + choice.action_class,
      fmt::join(actors, " "),
      choice.held_out.empty() ? "" : fmt::format(", {} held out", choice.held_out));
  return fold;
}

RootScale MakeRootScale(std::string_view unit, const std::vector<PreparedMotion>& motions) {
  RootScale root;
  if (unit == "metres") return root;
  if (unit == "authors") {
    root.scale.setConstant(kAuthorsUnit);
    return root;
  }
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  double count = 0;
  for (const PreparedMotion& motion : motions) {
    for (const PoseMatrix& poses : motion.phases) {
      for (Eigen::Index t = 0; t < poses.rows(); ++t) {
        const Vec3 p = poses.row(t).head<3>().transpose();
        sum += p;
        squares += p.cwiseAbs2();
        ++count;
      }
    }
  }
  root.mean = sum / count;
  const Vec3 deviation = (squares / count - root.mean.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  for (int axis = 0; axis < 3; ++axis) {
    if (deviation[axis] > kSmallestDeviation) root.scale[axis] = deviation[axis];
  }
  return root;
}

}  // namespace poise::synthesis
