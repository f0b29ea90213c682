#include "core/motion/kinematics/fabrik.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace poise::motion {
namespace {

Vec3 RandomVector(base::Random& random) {
  return {random.Normal(), random.Normal(), random.Normal()};
}

struct TwoBones {
  Vec3 base, middle, end, target;
  double upper, lower;
};

// A bent limb and a target inside its shell by at least `margin` of the shell's thickness.
TwoBones RandomTwoBones(base::Random& random, double margin) {
  TwoBones limb;
  limb.upper = random.Uniform(0.2, 0.5);
  limb.lower = random.Uniform(0.2, 0.5);
  limb.base = RandomVector(random);
  limb.middle = limb.base + limb.upper * RandomVector(random).normalized();
  limb.end = limb.middle + limb.lower * RandomVector(random).normalized();
  const double inner = std::abs(limb.upper - limb.lower), outer = limb.upper + limb.lower;
  const double u = random.Uniform(margin, 1 - margin);
  limb.target = limb.base + (inner + u * (outer - inner)) * RandomVector(random).normalized();
  return limb;
}

TEST(FabrikTest, TwoBonesInClosedFormMeetTheTargetWithTheirLengths) {
  base::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const TwoBones limb = RandomTwoBones(random, 0.001);
    const Vec3 middle = SolveTwoBones(limb.base, limb.middle, limb.upper, limb.lower, limb.target);
    EXPECT_NEAR((middle - limb.base).norm(), limb.upper, 1e-12);
    EXPECT_NEAR((limb.target - middle).norm(), limb.lower, 1e-9);
    // In the plane of base, target and the old middle, on the old one's side.
    const Vec3 line = limb.target - limb.base;
    const Vec3 old_normal = line.cross(limb.middle - limb.base).normalized();
    EXPECT_NEAR((middle - limb.base).dot(old_normal), 0, 1e-9);
    EXPECT_GE(line.cross(middle - limb.base).dot(old_normal), 0);
  }
}

TEST(FabrikTest, TheIterationOnTwoBonesEndsAtTheClosedForm) {
  base::Random random(2);
  for (int i = 0; i < 500; ++i) {
    const TwoBones limb = RandomTwoBones(random, 0.1);
    std::array<Vec3, 3> joints = {limb.base, limb.middle, limb.end};
    const FabrikResult result = SolveFabrik(joints, std::array{limb.upper, limb.lower}, limb.target,
                                            {.tolerance = 1e-9, .max_iterations = 20'000});
    EXPECT_LE(result.error_m, 1e-9);
    const Vec3 expected =
        SolveTwoBones(limb.base, limb.middle, limb.upper, limb.lower, limb.target);
    EXPECT_LT((joints[1] - expected).norm(), 1e-6) << "limb " << i;
  }
}

TEST(FabrikTest, LongChainsMeetTheirTargetsAndKeepBaseAndLengths) {
  base::Random random(3);
  for (int i = 0; i < 300; ++i) {
    const int bones = 3 + static_cast<int>(random.Index(6));
    std::vector<Vec3> joints = {RandomVector(random)};
    std::vector<double> lengths;
    for (int bone = 0; bone < bones; ++bone) {
      lengths.push_back(random.Uniform(0.1, 0.3));
      joints.push_back(joints.back() + lengths.back() * RandomVector(random).normalized());
    }
    const Vec3 base = joints[0];
    const Vec3 target =
        base + random.Uniform(0.2, 0.25 * bones / 3) * RandomVector(random).normalized();
    const FabrikResult result = SolveFabrik(joints, lengths, target, {.max_iterations = 1000});
    EXPECT_LE(result.error_m, 1e-4);
    EXPECT_EQ(joints[0], base);
    for (int bone = 0; bone < bones; ++bone) {
      EXPECT_NEAR((joints[bone + 1] - joints[bone]).norm(), lengths[bone], 1e-12);
    }
  }
}

TEST(FabrikTest, AnUnreachableTargetStretchesTheChainTowardsIt) {
  std::array<Vec3, 4> joints = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)};
  const FabrikResult result = SolveFabrik(joints, std::array{1.0, 1.0, 1.0}, Vec3(0, 0, 5));
  EXPECT_NEAR(result.error_m, 2, 1e-12);
  EXPECT_LT((joints[1] - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((joints[3] - Vec3(0, 0, 3)).norm(), 1e-12);
}

TEST(FabrikTest, CoincidentJointsAndTargetsAtTheBaseGiveFiniteNumbers) {
  std::array<Vec3, 3> joints = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  SolveFabrik(joints, std::array{0.5, 0.4}, Vec3(0.1, 0.2, 0.3));
  for (const Vec3& joint : joints) EXPECT_TRUE(joint.allFinite());
  EXPECT_TRUE(SolveTwoBones(Vec3::Zero(), Vec3(0, -0.5, 0), 0.5, 0.4, Vec3::Zero()).allFinite());
  EXPECT_TRUE(
      SolveTwoBones(Vec3::Zero(), Vec3(0, -0.5, 0), 0.5, 0.4, Vec3(0, -0.6, 0)).allFinite());
}

}  // namespace
}  // namespace poise::motion
