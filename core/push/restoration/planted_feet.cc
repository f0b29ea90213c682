#include "core/push/restoration/planted_feet.h"

#include <algorithm>
#include <cmath>

#include "core/motion/kinematics/fabrik.h"

namespace poise::push {
namespace {

constexpr std::array kHips = {kRightHip, kLeftHip};  // knee, ankle and toe follow
constexpr double kStraightKneeForward = 0.02;        // [m] beside how far the knee is out already
constexpr double kStraight = 0.999;  // of the leg's length: a straight knee has no side

// The point at `radius` from `toe` and at most `reach` from `hip`, as near to `ankle` as may be.
Vec3 RaisedAnkle(const Vec3& hip, const Vec3& toe, const Vec3& ankle, double radius, double reach) {
  const Vec3 line = hip - toe;
  const double distance = line.norm();
  const Vec3 along = line / distance;
  const double cosine =
      (distance * distance + radius * radius - reach * reach) / (2 * distance * radius);
  const double clamped = std::clamp(cosine, -1.0, 1.0);
  Vec3 side = ankle - toe;
  side -= along * along.dot(side);
  const double length = side.norm();
  if (length > 0) side /= length;
  return toe + radius * (clamped * along + std::sqrt(1 - clamped * clamped) * side);
}

void Aim(const Vec3& bone, const Vec3& now, math::Quat& turn) {
  turn = (math::SwingBetween(turn * bone, now) * turn).normalized();
}

void PlantFoot(const BodyShape& first, int hip_joint, const Vec3& goal, BodyTurns& turns) {
  const int knee_joint = hip_joint + 1, ankle_joint = hip_joint + 2, toe_joint = hip_joint + 3;
  const Vec3 thigh = first[knee_joint] - first[hip_joint];
  const Vec3 shank = first[ankle_joint] - first[knee_joint];
  const Vec3 foot = first[toe_joint] - first[ankle_joint];
  const Vec3 hip = turns[kPelvis] * (first[hip_joint] - first[kPelvis]);
  const Vec3 knee_before = turns[hip_joint] * thigh;  // from the hip
  const Vec3 ankle_before = knee_before + turns[knee_joint] * shank;
  const Vec3 toes_ahead = (turns[ankle_joint] * foot).normalized();
  const double reach = kStraight * (thigh.norm() + shank.norm());
  Vec3 ankle = goal - turns[ankle_joint] * foot;
  if ((ankle - hip).norm() > reach) ankle = RaisedAnkle(hip, goal, ankle, foot.norm(), reach);
  // The knee stays on its side of the leg as it turns; that of a straight leg bends to the toes.
  const Vec3 side = math::SwingBetween(ankle_before, ankle - hip) * knee_before +
                    kStraightKneeForward * toes_ahead;
  const Vec3 knee = motion::SolveTwoBones(hip, hip + side, thigh.norm(), shank.norm(), ankle);
  const Vec3 foot_now = goal - ankle;
  Aim(thigh, knee - hip, turns[hip_joint]);
  Aim(shank, ankle - knee, turns[knee_joint]);
  Aim(foot, foot_now, turns[ankle_joint]);
  turns[toe_joint] = turns[ankle_joint];
}

}  // namespace

void PlantFeet(const BodyShape& first, const std::array<Vec3, 2>& toes, BodyTurns& turns) {
  for (size_t foot = 0; foot < toes.size(); ++foot) {
    PlantFoot(first, kHips[foot], toes[foot], turns);
  }
}

}  // namespace poise::push
