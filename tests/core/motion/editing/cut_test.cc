#include "core/motion/editing/cut.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

TEST(CutTest, KeepsTheFramesAskedForBitForBit) {
  const Clip clip = testing::SwingingClip(10);
  const auto cut = Cut(clip, 3, 4);
  ASSERT_TRUE(cut.ok()) << cut.status();
  EXPECT_EQ(cut->num_frames(), 4);
  EXPECT_EQ(cut->frame_rate(), clip.frame_rate());
  EXPECT_EQ(cut->root_position(3), clip.root_position(6));
  EXPECT_EQ(cut->rotation(0, 5).coeffs(), clip.rotation(3, 5).coeffs());
}

TEST(CutTest, FramesOutsideTheClipAreRefused) {
  const Clip clip = testing::SwingingClip(10);
  for (const auto& [first, count] : {std::pair{-1, 2}, {0, 0}, {8, 3}, {2, 2'000'000'000}}) {
    EXPECT_EQ(base::ErrorReason(Cut(clip, first, count).status()), "BAD_FRAME_RANGE");
  }
}

TEST(TakeEveryTest, KeepsEveryStepthFrameFromTheFirstOn) {
  const Clip clip = testing::SwingingClip(10, 120);
  const auto thinned = TakeEvery(clip, 4);
  ASSERT_TRUE(thinned.ok());
  ASSERT_EQ(thinned->num_frames(), 3);
  EXPECT_EQ(thinned->frame_rate(), 30);
  EXPECT_EQ(thinned->root_position(2), clip.root_position(8));
  EXPECT_EQ(base::ErrorReason(TakeEvery(clip, 0).status()), "BAD_STEP");
}

}  // namespace
}  // namespace poise::motion
