#include "samples/author/track.h"

#include <gtest/gtest.h>

namespace poise::samples {
namespace {

using math::Vec3;

const ScalarTrack kTrack{{0, 1}, {0.5, 3}, {1.2, 2, Pass::kRest}, {1.5, 2, Pass::kRest}, {2, -1}};

TEST(TrackTest, PassesThroughItsKeysAndHoldsTheEnds) {
  EXPECT_DOUBLE_EQ(kTrack(-1), 1);
  EXPECT_DOUBLE_EQ(kTrack(0), 1);
  EXPECT_NEAR(kTrack(0.5), 3, 1e-12);
  EXPECT_NEAR(kTrack(1.2), 2, 1e-12);
  EXPECT_DOUBLE_EQ(kTrack(2), -1);
  EXPECT_DOUBLE_EQ(kTrack(9), -1);
}

TEST(TrackTest, StandsStillBetweenEqualRestKeys) {
  for (double t = 1.2; t <= 1.5; t += 0.01) EXPECT_DOUBLE_EQ(kTrack(t), 2);
}

TEST(TrackTest, VelocityAndAccelerationAreContinuousAtKeys) {
  const double h = 1e-4;
  for (const double key : {0.0, 0.5, 1.2, 1.5, 2.0}) {
    const auto velocity = [&](double t) { return (kTrack(t + h) - kTrack(t - h)) / (2 * h); };
    const auto acceleration = [&](double t) {
      return (kTrack(t + h) - 2 * kTrack(t) + kTrack(t - h)) / (h * h);
    };
    EXPECT_NEAR(velocity(key - 2 * h), velocity(key + 2 * h), 0.02) << key;
    EXPECT_NEAR(acceleration(key - 2 * h), acceleration(key + 2 * h), 1.0) << key;
  }
}

TEST(TrackTest, ReproducesAParabolaAwayFromItsEnds) {
  const auto parabola = [](double t) { return Vec3(t * t, 1 - 2 * t, 3 * t * t - t); };
  std::vector<Key<Vec3>> keys;
  for (const double t : {0.0, 0.3, 0.7, 0.9, 1.6, 2.0}) keys.push_back({t, parabola(t)});
  const VectorTrack track(keys);
  for (double t = 0.3; t <= 1.6; t += 0.05) {
    EXPECT_LT((track(t) - parabola(t)).norm(), 1e-12) << t;
  }
}

}  // namespace
}  // namespace poise::samples
