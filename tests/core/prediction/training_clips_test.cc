#include "core/prediction/training/training_clips.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::prediction {
namespace {

motion::BenchmarkClips Benchmark() {
  motion::BenchmarkClips clips;
  for (const int frames : {100, 30, 9}) {
    clips.train.push_back({"swing", "", testing::SwingingClip(frames, 60)});
  }
  clips.test.push_back({"swing", "", testing::SwingingClip(50, 60)});
  return clips;
}

TEST(SplitForTrainingTest, EndsOfLongSequencesAreHeldOutAndNoFrameIsInBoth) {
  const auto split = SplitForTraining(
      Benchmark(), {.window = 20, .validation_share = 0.3, .mirror = false, .speeds = false});
  ASSERT_TRUE(split.ok()) << split.status();
  ASSERT_EQ(split->train.size(), 2u);  // nine frames are no window
  ASSERT_EQ(split->train[0].size(), 1u);
  EXPECT_EQ(split->train[0][0].num_frames(), 70);
  EXPECT_EQ(split->train[1][0].num_frames(), 30);  // too short to share
  ASSERT_EQ(split->validation.size(), 1u);
  EXPECT_EQ(split->validation[0].num_frames(), 30);
  EXPECT_EQ(split->validation[0].root_position(0),
            testing::SwingingClip(100, 60).root_position(70));
}

TEST(SplitForTrainingTest, VariantsAreLearnedFromButNotChosenBy) {
  const auto split = SplitForTraining(
      Benchmark(), {.window = 28, .validation_share = 0, .drop_first_frame = true});
  ASSERT_TRUE(split.ok()) << split.status();
  ASSERT_EQ(split->train.size(), 2u);
  EXPECT_EQ(split->train[0].size(), 10u);  // itself and four speeds, and their mirror images
  EXPECT_EQ(split->train[1].size(), 6u);   // two of the faster ones are shorter than a window
  EXPECT_TRUE(split->validation.empty());
  const motion::Clip &itself = split->train[0][9], &mirrored = split->train[0][8];
  EXPECT_EQ(itself.root_position(0), testing::SwingingClip(100, 60).root_position(1));
  EXPECT_NEAR(mirrored.root_position(0).x(), -itself.root_position(0).x(), 1e-12);
}

TEST(SplitForTrainingTest, SequencesShorterThanAWindowAreRefused) {
  EXPECT_EQ(base::ErrorReason(SplitForTraining(Benchmark(), {.window = 200}).status()),
            "NO_WINDOWS");
}

}  // namespace
}  // namespace poise::prediction
