#include "tests/support/broken_clips.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/motion/kinematics/forward_kinematics.h"

namespace poise::testing {
namespace {

using motion::JointRole;
using motion::Vec3;

constexpr double kOff = 0.05;          // [m] too high or too low
constexpr double kTurn = 0.25;         // [rad] of a thigh
constexpr double kGlideRadius = 0.12;  // [m]
constexpr double kGlideHz = 0.4;

double MinimumJerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

// 0 at both ends of the clip, 1 in its middle.
double Part(int frame, int frames) {
  const double u = static_cast<double>(frame) / (frames - 1);
  return MinimumJerk((u - 0.15) / 0.15) * MinimumJerk((0.85 - u) / 0.15);
}

void CrossLegs(const motion::JointRoles& roles, motion::Clip& clip) {
  const motion::WorldPoses world = motion::ForwardKinematics(clip);
  for (int f = 0; f < clip.num_frames(); ++f) {
    for (const auto& [role, sign] :
         {std::pair(JointRole::kLeftHip, -1), std::pair(JointRole::kRightHip, 1)}) {
      const int hip = roles.joint(role);
      const Vec3 forward = world.rotation(f, roles.joint(JointRole::kPelvis)) * Vec3::UnitZ();
      const Vec3 axis = world.rotation(f, clip.skeleton()->parent(hip)).conjugate() * forward;
      clip.rotation(f, hip) =
          math::FromRotationVector(sign * kTurn * Part(f, clip.num_frames()) * axis) *
          clip.rotation(f, hip);
    }
  }
}

}  // namespace

std::string_view FaultName(Fault fault) {
  switch (fault) {
    case Fault::kCrossedLegs:
      return "crossed_legs";
    case Fault::kSunk:
      return "sunk_5cm";
    case Fault::kSlidingFeet:
      return "sliding_feet";
    case Fault::kFloating:
      return "floating_5cm";
  }
  return "";
}

motion::Clip Break(motion::Clip clip, const motion::JointRoles& roles, Fault fault) {
  if (fault == Fault::kCrossedLegs) CrossLegs(roles, clip);
  for (int f = 0; f < clip.num_frames(); ++f) {
    const double phase = 2 * std::numbers::pi * kGlideHz * f / clip.frame_rate();
    const double off = kOff * Part(f, clip.num_frames());
    if (fault == Fault::kSunk) clip.root_position(f).y() -= off;
    if (fault == Fault::kFloating) clip.root_position(f).y() += off;
    if (fault == Fault::kSlidingFeet) {
      clip.root_position(f) += kGlideRadius * Vec3(std::sin(phase), 0, 1 - std::cos(phase));
    }
  }
  return clip;
}

}  // namespace poise::testing
