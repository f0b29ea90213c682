#include "core/correction/tracking/stance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/correction/tracked_clip.h"

namespace poise::correction {
namespace {

constexpr int kRightFoot = 6, kLeftFoot = 12, kLeftKnee = 11;

// Two soles of four points each, 0.3 m apart.
Stances TwoSoles() {
  Stances stances;
  for (const auto& [body, x] : {std::pair(kRightFoot, -0.15), std::pair(kLeftFoot, 0.15)}) {
    for (const double dx : {-0.04, 0.04}) {
      for (const double dz : {-0.07, 0.07}) {
        stances.points[stances.count++] = {
            .body = body, .point = Vec3(x + dx, 0, dz), .force = Vec3::Zero()};
      }
    }
  }
  return stances;
}

Vec3 Sum(const Stances& stances) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < stances.count; ++i) sum += stances.points[i].force;
  return sum;
}

TEST(StanceTest, SharesAWeightOverBothFeet) {
  Stances stances = TwoSoles();
  ShareWrench(Vec3(0, 0.9, 0), Vec3(0, 441, 0), Vec3::Zero(), {}, stances);
  EXPECT_NEAR(Sum(stances).y(), 441, 1);
  for (int i = 0; i < stances.count; ++i) EXPECT_NEAR(stances.points[i].force.y(), 55, 1);
}

TEST(StanceTest, AWeightAboveOneFootIsCarriedByThatFoot) {
  Stances stances = TwoSoles();
  const Vec3 weight(0, 441, 0);
  ShareWrench(Vec3(0, 0.9, 0), weight, Vec3(0.15, 0, 0).cross(weight), {}, stances);
  double left = 0;
  for (int i = 4; i < 8; ++i) left += stances.points[i].force.y();
  EXPECT_GT(left, 0.85 * 441);
}

TEST(StanceTest, AFootThatIsBeingLiftedHardlyCarries) {
  Stances stances = TwoSoles();
  for (int i = 0; i < 4; ++i) stances.points[i].load = 0.02;
  ShareWrench(Vec3(0, 0.9, 0), Vec3(0, 441, 0), Vec3::Zero(), {.moment_softness_m2 = 1}, stances);
  double right = 0;
  for (int i = 0; i < 4; ++i) right += stances.points[i].force.y();
  EXPECT_GT(right, 0);
  EXPECT_LT(right, 0.05 * 441);
}

TEST(StanceTest, NoPointPullsOrSlides) {
  Stances stances = TwoSoles();
  ShareWrench(Vec3(0, 0.9, 0), Vec3(600, 300, 0), Vec3(200, 0, 100), {.friction = 0.5}, stances);
  for (int i = 0; i < stances.count; ++i) {
    const Vec3& force = stances.points[i].force;
    EXPECT_GE(force.y(), 0);
    EXPECT_LE(std::hypot(force.x(), force.z()), 0.5 * force.y() + 1e-9);
  }
}

TEST(StanceTest, TorquesPassTheGroundsForcesOn) {
  const TrackedClip clip = Prepare(SwayingClip(1));
  const physics::Articulation& tree = clip.model->articulation();
  const physics::BodyFrames frames = physics::ComputeFrames(tree, clip.reference.frame(0));
  Stances stances = TwoSoles();
  ShareWrench(Vec3(0, 0.9, 0), Vec3(50, 441, 20), Vec3(5, 0, 8), {}, stances);
  const physics::Speeds torques = StanceTorques(tree, frames, stances);
  EXPECT_TRUE(torques.head<6>().isZero());
  // Virtual work of a turn of the left knee, which moves the left sole's points.
  const Vec3 turn(0.3, -0.2, 0.5);
  double work = torques.segment<3>(physics::SpeedIndex(kLeftKnee))
                    .dot(frames.rotations[kLeftKnee].conjugate() * turn);
  for (int i = 4; i < 8; ++i) {
    const Vec3 arm = stances.points[i].point - frames.positions[kLeftKnee];
    work += stances.points[i].force.dot(turn.cross(arm));
  }
  EXPECT_NEAR(work, 0, 1e-9);
}

}  // namespace
}  // namespace poise::correction
