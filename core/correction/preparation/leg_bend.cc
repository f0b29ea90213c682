#include "core/correction/preparation/leg_bend.h"

#include <algorithm>
#include <cmath>

#include "core/motion/kinematics/fabrik.h"

namespace poise::correction {
namespace {

constexpr double kReach = 0.999;      // of the leg's length
constexpr double kBendHint_m = 0.01;  // [m] towards the toes, for a straight leg

// A leg in one frame, in the world.
struct Leg {
  Vec3 hip, knee, ankle;
  Quat thigh, shin;  // world from joint
  Quat pelvis;
  double upper, lower;  // [m]

  Leg(const motion::Clip& clip, int frame, const FootTrack& foot) {
    const motion::Skeleton& skeleton = *clip.skeleton();
    pelvis = clip.rotation(frame, 0);
    thigh = pelvis * clip.rotation(frame, foot.hip);
    shin = thigh * clip.rotation(frame, foot.knee);
    hip = clip.root_position(frame) + pelvis * skeleton.joint(foot.hip).offset;
    knee = hip + thigh * skeleton.joint(foot.knee).offset;
    ankle = knee + shin * skeleton.joint(foot.ankle).offset;
    upper = (knee - hip).norm();
    lower = (ankle - knee).norm();
  }
  double longest() const { return kReach * (upper + lower); }
};

}  // namespace

double DropToReach(const motion::Clip& clip, int frame, const FootTrack& foot, const Vec3& ankle) {
  const Leg leg(clip, frame, foot);
  const Vec3 down = leg.hip - ankle;
  const double sideways2 = down.x() * down.x() + down.z() * down.z();
  const double most = leg.longest() * leg.longest() - sideways2;
  return std::max(0.0, down.y() - std::sqrt(std::max(most, 0.0)));
}

void BendLeg(const FootTarget& target, int frame, const FootTrack& foot, motion::Clip& clip) {
  const Leg leg(clip, frame, foot);
  Vec3 reach = target.ankle - leg.hip;
  const double distance = reach.norm();
  const double shortest = std::abs(leg.upper - leg.lower) + 1e-3;
  if (distance > 1e-9) reach *= std::clamp(distance, shortest, leg.longest()) / distance;
  const Vec3 hint = leg.knee + kBendHint_m * (target.rotation * foot.forward);
  const Vec3 end = leg.hip + reach;
  const Vec3 knee = motion::SolveTwoBones(leg.hip, hint, leg.upper, leg.lower, end);
  const Quat swing = math::SwingBetween(leg.knee - leg.hip, knee - leg.hip);
  const Quat thigh = swing * leg.thigh;
  const Vec3 shin_now = swing * (leg.ankle - leg.knee);
  const Quat shin = math::SwingBetween(shin_now, end - knee) * (swing * leg.shin);
  clip.rotation(frame, foot.hip) = (leg.pelvis.conjugate() * thigh).normalized();
  clip.rotation(frame, foot.knee) = (thigh.conjugate() * shin).normalized();
  clip.rotation(frame, foot.ankle) = (shin.conjugate() * target.rotation).normalized();
}

}  // namespace poise::correction
