#include "core/motion/metrics/smoothness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/random.h"

namespace poise::motion {
namespace {

WorldPoses Track(int frames, const std::function<Vec3(int, int)>& position, int joints = 1) {
  WorldPoses world;
  world.num_frames = frames;
  world.num_joints = joints;
  for (int frame = 0; frame < frames; ++frame) {
    for (int joint = 0; joint < joints; ++joint) world.positions.push_back(position(frame, joint));
  }
  return world;
}

TEST(SmoothnessTest, AFallHasGravityAndNoJerk) {
  const double rate = 120;
  const WorldPoses world = Track(200, [&](int frame, int) {
    const double t = frame / rate;
    return Vec3(2 * t, 3 - 4.905 * t * t, -t);
  });
  EXPECT_NEAR(AccelerationRms(world, rate), 9.81, 1e-6);
  EXPECT_NEAR(JerkRms(world, rate), 0, 1e-4);
}

TEST(SmoothnessTest, ASineHasItsAnalyticAccelerationAndJerk) {
  // x = A sin(w t) over whole periods: RMS A w^2 / sqrt 2 and A w^3 / sqrt 2; differences of step h
  // multiply by (2 sin(w h / 2) / (w h))^2 and ^3.
  const double rate = 240, amplitude = 0.2, w = 2 * std::numbers::pi;
  const WorldPoses world = Track(
      24000, [&](int frame, int) { return Vec3(0, 0, amplitude * std::sin(w * frame / rate)); });
  const double factor = 2 * std::sin(w / rate / 2) / (w / rate);
  const double root = std::sqrt(0.5);
  EXPECT_NEAR(AccelerationRms(world, rate), amplitude * w * w * root * factor * factor, 1e-3);
  EXPECT_NEAR(JerkRms(world, rate), amplitude * w * w * w * root * std::pow(factor, 3), 1e-2);
}

TEST(SmoothnessTest, AgreesWithTheLoopWrittenOutForSeveralJoints) {
  base::Random random(1);
  const WorldPoses world = Track(
      6, [&](int, int) { return Vec3(random.Normal(), random.Normal(), random.Normal()); }, 3);
  double acceleration = 0, jerk = 0;
  for (int joint = 0; joint < 3; ++joint) {
    const auto x = [&](int frame) { return world.position(frame, joint); };
    for (int t = 1; t < 5; ++t) {
      acceleration += (x(t + 1) - 2 * x(t) + x(t - 1)).squaredNorm() / 12;
    }
    for (int t = 1; t < 4; ++t) {
      jerk += (x(t + 2) - 3 * x(t + 1) + 3 * x(t) - x(t - 1)).squaredNorm() / 9;
    }
  }
  EXPECT_NEAR(AccelerationRms(world, 10), 100 * std::sqrt(acceleration), 1e-9);
  EXPECT_NEAR(JerkRms(world, 10), 1000 * std::sqrt(jerk), 1e-9);
}

}  // namespace
}  // namespace poise::motion
