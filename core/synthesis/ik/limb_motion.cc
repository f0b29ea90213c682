#include "core/synthesis/ik/limb_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace poise::synthesis {
namespace {

using motion::Quat;
using motion::Vec3;

constexpr double kInnerMargin = 1e-3;     // [m] (sec. 3.5 step 2)
constexpr double kOuterFraction = 0.999;  // of the limb's length (sec. 3.5 step 2)
constexpr int kFramesAtOnce = 256;
// A limb whose bend has a sine below this counts as straight, the more the smaller it is.
constexpr double kStraightSine = 0.05;  // 3 degrees
// Displacement at which half of what changes the bend plane is there [m]. It must vanish
// with the displacement: otherwise the knee would jump where the edit begins.
constexpr double kHalfPush = 0.02;
// [rad] How near to straight and to fully folded a limb's flexion slows down.
constexpr double kSoftStraight = 0.05;
constexpr double kSoftFolded = 0.3;
// Half of the time over which the bend plane is averaged [s].
constexpr double kSteadyTime = 0.05;
constexpr double kLeastFlexion = 1e-4;  // [rad]

// The part of `vector` across the unit vector `axis`.
Vec3 Across(const Vec3& vector, const Vec3& axis) { return vector - axis * axis.dot(vector); }

// Maps all real numbers to positive ones, smoothly; far from 0 nothing changes.
double Soft(double x, double width) { return width * std::log1p(std::exp(x / width)); }
double InverseSoft(double y, double width) {
  const double u = std::max(y, kLeastFlexion) / width;
  return u > 30 ? width * u : width * std::log(std::expm1(u));
}

// `flexion` changed by `change`, but never to below 0 or above pi: less and less the nearer it
// comes. The end's distance from the base would be a poor coordinate for a limb that is nearly
// straight: there a millimetre moves the knee by a centimetre.
double ChangeFlexion(double flexion, double change) {
  if (change < 0) {
    const double from = InverseSoft(flexion, kSoftStraight);
    return flexion + Soft(from + change, kSoftStraight) - Soft(from, kSoftStraight);
  }
  const double from = InverseSoft(std::numbers::pi - flexion, kSoftFolded);
  return flexion - Soft(from - change, kSoftFolded) + Soft(from, kSoftFolded);
}

// The change that leads from one flexion to another.
double FlexionChange(double from, double to) {
  if (to < from) return InverseSoft(to, kSoftStraight) - InverseSoft(from, kSoftStraight);
  return InverseSoft(std::numbers::pi - from, kSoftFolded) -
         InverseSoft(std::numbers::pi - to, kSoftFolded);
}

double FlexionOf(double upper, double lower, double radius) {
  const double cosine = (radius * radius - upper * upper - lower * lower) / (2 * upper * lower);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double RadiusOf(double upper, double lower, double flexion) {
  return std::sqrt(
      std::max(0.0, upper * upper + lower * lower + 2 * upper * lower * std::cos(flexion)));
}

}  // namespace

LimbMotion::LimbMotion(const motion::Clip& clip, const Limb& limb, const Vec3& bend_direction,
                       int first, int count, const IkConfig& config)
    : limb_(limb),
      first_(first),
      iterative_(config.solver == "iterative"),
      swung_(config.bend_plane == "swung"),
      spread_limb_(config.spread == "limb"),
      fabrik_{.tolerance = config.tolerance, .max_iterations = config.max_iterations},
      max_flexion_(config.hinge_limit ? config.max_flexion : std::numbers::pi) {
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
                  .flexion = 0,
                  .bend = Vec3::Zero(),
                  .steady = Vec3::Zero(),
                  .base_rotation = poses.rotation(i, limb.base),
                  .base_parent = parent_rotation(i, limb.base),
                  .middle_rotation = poses.rotation(i, limb.middle),
                  .middle_parent = parent_rotation(i, limb.middle),
                  .end_rotation = poses.rotation(i, limb.end),
                  .end_parent = parent_rotation(i, limb.end)};
      frame.upper = (frame.middle - frame.base).norm();
      frame.lower = (frame.end - frame.middle).norm();
      frame.radius = (frame.end - frame.base).norm();
      frame.flexion = FlexionOf(frame.upper, frame.lower, frame.radius);
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
  if (swung_) SteadyBendPlane(clip.frame_rate());
}

// Captured limbs jitter about the line from base to end, which shows little while the limb is
// nearly straight. A variant that bends it farther would show it several times as large.
void LimbMotion::SteadyBendPlane(double frame_rate) {
  const int count = static_cast<int>(frames_.size());
  const int reach = static_cast<int>(std::lround(kSteadyTime * frame_rate));
  std::vector<Vec3> sides;  // of the middle joint, as seen from the joint above the limb
  for (const Frame& frame : frames_) {
    const Vec3 axis = (frame.end - frame.base).normalized();
    sides.push_back(frame.base_parent.conjugate() * Across(frame.middle - frame.base, axis));
  }
  for (int i = 0; i < count; ++i) {
    Frame& frame = frames_[i];
    const int near = std::min({reach, i, count - 1 - i});  // symmetric, also at the ends
    Vec3 mean = Vec3::Zero();
    for (int j = i - near; j <= i + near; ++j) mean += sides[j] / (2 * near + 1);
    const Vec3 axis = (frame.end - frame.base).normalized();
    frame.steady = Across(frame.base_parent * (mean - sides[i]), axis);
  }
}

Shell LimbMotion::ShellOf(const Frame& frame) const {
  return {.inner = std::max(std::abs(frame.upper - frame.lower) + kInnerMargin,
                            RadiusOf(frame.upper, frame.lower, max_flexion_)),
          .outer = kOuterFraction * (frame.upper + frame.lower)};
}

double LimbMotion::ClampToShell(const Frame& frame, double radius) const {
  const Shell shell = ShellOf(frame);
  return std::clamp(radius, std::min(shell.inner, frame.radius),
                    std::max(shell.outer, frame.radius));
}

LimbMotion::Edit LimbMotion::Plan(int keyframe, const Vec3& target) const {
  const Frame& frame = At(keyframe);
  const double radius = ClampToShell(frame, (target - frame.base).norm());
  return {.displacement = target - frame.end,
          .swing = math::ToRotationVector(
              math::SwingBetween(frame.end - frame.base, target - frame.base)),
          .flexion = FlexionChange(frame.flexion, FlexionOf(frame.upper, frame.lower, radius))};
}

Vec3 LimbMotion::SpreadPosition(const Frame& frame, double weight, const Edit& edit) const {
  const Vec3 wanted = frame.end + weight * edit.displacement - frame.base;
  const double distance = wanted.norm();
  const double radius = ClampToShell(frame, distance);
  // A target on the base itself leaves the direction free: keep the old one.
  if (distance < 1e-9) return frame.base + (frame.end - frame.base) * (radius / frame.radius);
  return frame.base + wanted * (radius / distance);
}

Vec3 LimbMotion::SpreadLimb(const Frame& frame, double weight, const Edit& edit) const {
  const double flexion =
      std::clamp(ChangeFlexion(frame.flexion, weight * edit.flexion), 0.0, std::numbers::pi);
  const double radius = ClampToShell(frame, RadiusOf(frame.upper, frame.lower, flexion));
  const Quat swing = math::FromRotationVector(weight * edit.swing);
  return frame.base + swing * (frame.end - frame.base) * (radius / frame.radius);
}

Vec3 LimbMotion::SolveMiddle(const Frame& frame, const Vec3& target, double weight,
                             Vec3& end) const {
  // Where the iteration starts decides the bend plane.
  const double displaced = (target - frame.end).norm();
  const double push = displaced / (displaced + kHalfPush);
  Vec3 start = frame.middle + push * (frame.bend + weight * frame.steady);
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

Vec3 LimbMotion::Apply(int frame_index, double weight, const Edit& edit,
                       motion::Clip& variant) const {
  const Frame& frame = At(frame_index);
  const Vec3 target =
      spread_limb_ ? SpreadLimb(frame, weight, edit) : SpreadPosition(frame, weight, edit);
  Vec3 end;
  const Vec3 middle = SolveMiddle(frame, target, weight, end);
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
