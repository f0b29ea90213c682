#include "core/motion/metrics/floor_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace poise::motion {
namespace {

// Two feet of one point each (all four corners together), moved along paths; nothing else.
PlacedBodies TwoFeet(int frames, const std::function<Vec3(int frame, int foot)>& path) {
  PlacedBodies bodies;
  bodies.num_frames = frames;
  for (int frame = 0; frame < frames; ++frame) {
    const Vec3 right = path(frame, 0), left = path(frame, 1);
    for (const Vec3& foot : {right, left}) bodies.soles.insert(bodies.soles.end(), 4, foot);
    bodies.lowest.push_back(std::min(right.y(), left.y()));
  }
  return bodies;
}

TEST(FloorContactTest, TheFloorIsWhereFeetAreStill) {
  // Right foot stands at -0.08, left foot swings above it.
  const PlacedBodies bodies = TwoFeet(100, [](int frame, int foot) {
    return foot == 0 ? Vec3(0, -0.08, 0)
                     : Vec3(0, 0.1 + 0.05 * std::sin(0.3 * frame), 0.05 * frame);
  });
  EXPECT_DOUBLE_EQ(MeasureFloorContact(bodies, 60, {}).floor_height_m, -0.08);
}

TEST(FloorContactTest, AFootHeldUpIsNotTheFloor) {
  const PlacedBodies bodies =
      TwoFeet(100, [](int, int foot) { return Vec3(0, foot == 0 ? 0.0 : 0.5, 0); });
  EXPECT_DOUBLE_EQ(MeasureFloorContact(bodies, 60, {}).floor_height_m, 0);
}

TEST(FloorContactTest, SkatingIsWeightedByHeight) {
  // Right foot stands on the floor; the left one glides at 2 m/s half the contact height above it:
  // weights 1 and 2 - sqrt 2.
  const PlausibilityConfig config;
  const PlacedBodies bodies = TwoFeet(50, [&](int frame, int foot) {
    return foot == 0 ? Vec3(0, 0, 0) : Vec3(2.0 * frame / 60, config.contact_height_m / 2, 0);
  });
  const double weight = 2 - std::sqrt(2);
  EXPECT_NEAR(MeasureFloorContact(bodies, 60, config).foot_skate_mps, 2 * weight / (1 + weight),
              1e-12);
}

}  // namespace
}  // namespace poise::motion
