#include "core/motion/metrics/self_penetration.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/random.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

TEST(SegmentDistanceTest, KnownCasesAreExact) {
  const Vec3 x(1, 0, 0), z(0, 0, 1), none(0, 0, 0);
  const auto distance = [](Vec3 a, Vec3 u, Vec3 b, Vec3 v) {
    return SegmentDistance({a, u}, {b, v});
  };
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, none, {0, 3, 4}, none), 5);      // points
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {0, 2, 0}, z), 2);            // crossing
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {0.5, 2, 0}, x), 2);          // parallel
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {5, 4, 0}, x), 5);            // apart along the line
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {3, 0, 0}, z), 2);            // end to middle
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {0.3, -1.5, 0}, none), 1.5);  // point to middle
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}, x, {0.2, 0, 0.1}, z), 0);        // they cross
}

TEST(SegmentDistanceTest, NoFinelySampledPairOfPointsIsNearer) {
  base::Random random(2);
  const auto vec = [&] { return Vec3(random.Normal(), random.Normal(), random.Normal()); };
  for (int trial = 0; trial < 200; ++trial) {
    const PlacedCapsule a{vec(), vec()}, b{vec(), trial % 5 ? vec() : Vec3(2 * a.half_axis)};
    double sampled = 1e9;
    for (int i = -100; i <= 100; ++i) {
      for (int j = -100; j <= 100; ++j) {
        sampled = std::min(
            sampled,
            (a.center + i / 100.0 * a.half_axis - b.center - j / 100.0 * b.half_axis).norm());
      }
    }
    const double exact = SegmentDistance(a, b);
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_NEAR(exact, sampled, 0.1);
  }
}

TEST(SelfPenetrationTest, NeighboursAreLeftOutAndCrossingLegsAreNot) {
  const SkeletonPtr skeleton = testing::Biped();
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  const BodyShapes shapes = *MakeBodyShapes(*skeleton, roles, *SolesOfRestPose(*skeleton, roles));
  const auto pairs = SeparatePairs(shapes);
  const auto has = [&](JointRole a, JointRole b) {
    const auto pair = std::minmax({static_cast<int>(a), static_cast<int>(b)});
    return std::count(pairs.begin(), pairs.end(), std::pair(pair.first, pair.second)) == 1;
  };
  EXPECT_FALSE(has(JointRole::kLeftHip, JointRole::kLeftKnee));
  EXPECT_FALSE(has(JointRole::kPelvis, JointRole::kNeck));
  EXPECT_FALSE(has(JointRole::kSpine, JointRole::kLeftHip));
  EXPECT_FALSE(has(JointRole::kNeck, JointRole::kRightShoulder));
  EXPECT_TRUE(has(JointRole::kLeftHip, JointRole::kRightHip));
  EXPECT_TRUE(has(JointRole::kLeftHip, JointRole::kLeftAnkle));
  EXPECT_TRUE(has(JointRole::kChest, JointRole::kLeftElbow));
  EXPECT_TRUE(has(JointRole::kNeck, JointRole::kLeftWrist));
}

TEST(SelfPenetrationTest, TwoThighsTurnedIntoEachOtherOverlapByTheirRadii) {
  // Both hips turn inwards about Z until the capsules' centres meet: depth = both radii.
  const SkeletonPtr skeleton = testing::Biped();
  const JointRoles roles = *JointRoles::Detect(*skeleton);
  std::vector<Quat> pose(skeleton->num_joints(), Quat::Identity());
  // The middle of the thigh is 0.215 below a hip that is 0.10 off the middle.
  const double angle = std::asin(0.10 / 0.215);
  pose[roles.joint(JointRole::kLeftHip)] = Quat(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));
  pose[roles.joint(JointRole::kRightHip)] = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
  const Clip clip = *Clip::Create("crossed", skeleton, 30, {Vec3(0, 1, 0)}, pose);
  const BodyShapes shapes = *MakeBodyShapes(*skeleton, roles, *SolesOfRestPose(*skeleton, roles));
  PlacedBodies bodies;
  PlaceBodies(shapes, ForwardKinematics(clip), bodies);
  const double depth = WorstSelfPenetration(shapes, bodies);
  EXPECT_NEAR(depth, 2 * shapes[static_cast<int>(JointRole::kLeftHip)].radius, 1e-9);
}

}  // namespace
}  // namespace poise::motion
