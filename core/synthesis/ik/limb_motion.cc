#include "core/synthesis/ik/limb_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace poise::synthesis {
namespace {

using motion::Quat;
using motion::Vec3;

constexpr double kInnerMargin = 1e-3;     // [m] (sec. 3.5 step 2)
constexpr double kOuterFraction = 0.999;  // of the limb's length (sec. 3.5 step 2)
constexpr int kFramesAtOnce = 256;
// A limb whose bend has a sine below this counts as straight, the more the smaller it is.
constexpr double kStraightSine = 0.05;  // 3 degrees
// Displacement at which half of the push that bends a straight limb is there [m]. It must vanish
// with the displacement: otherwise the knee would jump where the edit begins.
constexpr double kHalfPush = 0.02;

// The part of `vector` across the unit vector `axis`.
Vec3 Across(const Vec3& vector, const Vec3& axis) { return vector - axis * axis.dot(vector); }

}  // namespace

LimbMotion::LimbMotion(const motion::Clip& clip, const Limb& limb, const Vec3& bend_direction,
                       int first, int count, const IkConfig& config)
    : limb_(limb),
      first_(first),
      iterative_(config.solver == "iterative"),
      swung_(config.bend_plane == "swung"),
      fabrik_{.tolerance = config.tolerance, .max_iterations = config.max_iterations},
      max_flexion_cosine_(config.hinge_limit ? std::cos(config.max_flexion) : -1) {
  const motion::Skeleton& skeleton = *clip.skeleton();
  motion::WorldPoses poses;
  frames_.reserve(count);
  for (int done = 0; done < count; done += kFramesAtOnce) {
    const int chunk = std::min(kFramesAtOnce, count - done);
    motion::ForwardKinematics(clip, first + done, chunk, poses);
    const auto parent_rotation = [&](int i, int joint) {
      const int parent = skeleton.parent(joint);
      return parent < 0 ? Quat::Identity() : poses.rotation(i, parent);
    };
    for (int i = 0; i < chunk; ++i) {
      Frame frame{.base = poses.position(i, limb.base),
                  .middle = poses.position(i, limb.middle),
                  .end = poses.position(i, limb.end),
                  .upper = 0,
                  .lower = 0,
                  .radius = 0,
                  .bend = Vec3::Zero(),
                  .base_rotation = poses.rotation(i, limb.base),
                  .base_parent = parent_rotation(i, limb.base),
                  .middle_rotation = poses.rotation(i, limb.middle),
                  .middle_parent = parent_rotation(i, limb.middle),
                  .end_rotation = poses.rotation(i, limb.end),
                  .end_parent = parent_rotation(i, limb.end)};
      frame.upper = (frame.middle - frame.base).norm();
      frame.lower = (frame.end - frame.middle).norm();
      frame.radius = (frame.end - frame.base).norm();
      const Vec3 axis = (frame.end - frame.base).normalized();
      const double sine = Across(frame.middle - frame.base, axis).norm() / frame.upper;
      if (sine < kStraightSine) {
        const double straightness = 1 - sine / kStraightSine;
        const Vec3 side = Across(frame.base_rotation * bend_direction, axis).normalized();
        frame.bend = frame.upper * kStraightSine * straightness * straightness * side;
      }
      frames_.push_back(frame);
    }
  }
}

Shell LimbMotion::ReachableShell(int frame) const {
  const Frame& f = frames_[frame - first_];
  const double flexed = std::sqrt(std::max(
      0.0, f.upper * f.upper + f.lower * f.lower + 2 * f.upper * f.lower * max_flexion_cosine_));
  return {.inner = std::max(std::abs(f.upper - f.lower) + kInnerMargin, flexed),
          .outer = kOuterFraction * (f.upper + f.lower)};
}

Vec3 LimbMotion::ClampToShell(const Frame& frame, const Vec3& target) const {
  const Shell shell = ReachableShell(first_ + static_cast<int>(&frame - frames_.data()));
  const Vec3 reach = target - frame.base;
  const double wanted = reach.norm();
  const double radius =
      std::clamp(wanted, std::min(shell.inner, frame.radius), std::max(shell.outer, frame.radius));
  if (wanted < 1e-9) return frame.base + (frame.end - frame.base) * (radius / frame.radius);
  return frame.base + reach * (radius / wanted);
}

Vec3 LimbMotion::SolveMiddle(const Frame& frame, const Vec3& target, double displaced,
                             Vec3& end) const {
  // Where the iteration starts decides the bend plane.
  const double push = displaced / (displaced + kHalfPush);
  Vec3 start = frame.middle + push * frame.bend;
  if (swung_) {
    const Quat swing = math::SwingBetween(frame.end - frame.base, target - frame.base);
    start = frame.base + swing * (start - frame.base);
  }
  if (!iterative_) {
    end = target;
    return motion::SolveTwoBones(frame.base, start, frame.upper, frame.lower, target);
  }
  std::array<Vec3, 3> joints = {frame.base, start, frame.end};
  motion::SolveFabrik(joints, std::array{frame.upper, frame.lower}, target, fabrik_);
  end = joints[2];
  return joints[1];
}

Vec3 LimbMotion::Displace(int frame_index, const Vec3& displacement, motion::Clip& variant) const {
  const Frame& frame = frames_[frame_index - first_];
  const Vec3 target = ClampToShell(frame, frame.end + displacement);
  Vec3 end;
  const Vec3 middle = SolveMiddle(frame, target, displacement.norm(), end);
  // The smallest turns of the two bones, in the world.
  const Quat turn_upper = math::SwingBetween(frame.middle - frame.base, middle - frame.base);
  const Quat turn_lower = math::SwingBetween(frame.end - frame.middle, end - middle);
  variant.rotation(frame_index, limb_.base) =
      frame.base_parent.conjugate() * turn_upper * frame.base_rotation;
  variant.rotation(frame_index, limb_.middle) =
      (turn_upper * frame.middle_parent).conjugate() * turn_lower * frame.middle_rotation;
  variant.rotation(frame_index, limb_.end) =
      (turn_lower * frame.end_parent).conjugate() * frame.end_rotation;
  return end;
}

}  // namespace poise::synthesis
