#include "core/synthesis/vae/vae_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

StatusOr<Fold> PrepareFold(const std::vector<motion::LabelledClip>& clips,
                           const motion::FoldChoice& choice, double frame_rate) {
  POISE_ASSIGN_OR_RETURN(const motion::FoldClips chosen, motion::ChooseFold(clips, choice));
  Fold fold{.train = {}, .held_out = {}, .description = chosen.description};
  for (const auto& [indices, motions] :
       {std::pair(&chosen.train, &fold.train), std::pair(&chosen.held_out, &fold.held_out)}) {
    for (const size_t i : *indices) {
      POISE_ASSIGN_OR_RETURN(motions->emplace_back(), PrepareMotion(clips[i].clip, frame_rate));
    }
  }
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
