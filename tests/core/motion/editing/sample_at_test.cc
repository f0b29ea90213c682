#include "core/motion/editing/sample_at.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

TEST(SampleAtTest, PlacesOnFramesGiveThemBitForBitAndOthersLieBetween) {
  const Clip clip = testing::SwingingClip(10);
  const std::vector<double> places = {9, 2.25, 3 + 1e-9};
  const auto sampled = SampleAt(clip, places, 60);
  ASSERT_TRUE(sampled.ok()) << sampled.status();
  EXPECT_EQ(sampled->frame_rate(), 60);
  EXPECT_EQ(sampled->rotation(0, 3).coeffs(), clip.rotation(9, 3).coeffs());
  EXPECT_EQ(sampled->rotation(2, 3).coeffs(), clip.rotation(3, 3).coeffs());
  EXPECT_LT(math::GeodesicDistance(sampled->rotation(1, 3),
                                   clip.rotation(2, 3).slerp(0.25, clip.rotation(3, 3))),
            1e-7);
  EXPECT_LT(
      (sampled->root_position(1) - (0.75 * clip.root_position(2) + 0.25 * clip.root_position(3)))
          .norm(),
      1e-12);
}

TEST(SampleAtTest, PlacesOutsideTheClipAreRefused) {
  const Clip clip = testing::SwingingClip(10);
  for (const double place : {-0.5, 9.01, std::nan("")}) {
    EXPECT_EQ(base::ErrorReason(SampleAt(clip, {{place}}, 60).status()), "BAD_FRAME_RANGE");
  }
}

}  // namespace
}  // namespace poise::motion
