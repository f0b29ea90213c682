#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/dataset/benchmark_clips.h"
#include "core/motion/dataset/clip_folder.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

using ::testing::HasSubstr;

std::vector<LabelledClip> Kicks() {
  std::vector<LabelledClip> clips;
  for (const char* actor : {"bd", "tr", "tr"}) {
    clips.push_back({"kickLFront1Reps", actor, testing::SwingingClip(120, 120)});
  }
  clips.push_back({"walk", "bd", testing::SwingingClip(90, 100)});
  return clips;
}

TEST(SetBenchmarkTest, TheActorWhoIsHeldOutIsTheTest) {
  const auto clips = MakeBenchmark(Kicks(), {.action_class = "kick", .hold_out = "tr"});
  ASSERT_TRUE(clips.ok()) << clips.status();
  ASSERT_EQ(clips->train.size(), 1u);
  EXPECT_EQ(clips->test.size(), 2u);
  EXPECT_EQ(clips->train[0].clip.num_joints(), 16);
  EXPECT_EQ(clips->train[0].clip.frame_rate(), 30);
  EXPECT_EQ(clips->train[0].clip.num_frames(), 30) << "every fourth frame";
  EXPECT_EQ(clips->counts, ColumnMask(48, true));
  EXPECT_EQ(clips->variant, EulerErrorVariant::kAllColumns);
}

TEST(SetBenchmarkTest, OtherRatesAreInterpolatedAndAllJointsKeptWhereAskedFor) {
  const auto clips = MakeBenchmark(Kicks(), {.form = {.body = "all"}});
  ASSERT_TRUE(clips.ok()) << clips.status();
  EXPECT_EQ(clips->train.size(), 4u);
  EXPECT_TRUE(clips->test.empty());
  EXPECT_EQ(clips->train[3].clip.num_frames(), 28) << "0.89 s at 30 Hz";
  EXPECT_EQ(clips->train[3].clip.num_joints(), testing::Biped()->num_joints());
  EXPECT_EQ(clips->counts.size(), 3u * testing::Biped()->num_joints());
}

TEST(SetBenchmarkTest, WhatCannotBeMeasuredIsRefusedWithTheReason) {
  const auto reason = [](const BenchmarkRules& rules) {
    return base::ErrorReason(MakeBenchmark(Kicks(), rules).status());
  };
  EXPECT_EQ(reason({.action_class = "jog"}), "NO_CLIPS");
  EXPECT_EQ(reason({.hold_out = "xx"}), "NO_CLIPS");
  EXPECT_EQ(reason({.form = {.frame_rate = 0}}), "MIXED_RATES");
  EXPECT_THAT(base::Message(MakeBenchmark(Kicks(), {.hold_out = "xx"}).status()),
              HasSubstr("bd, tr"));
}

// A registered data set gives the numbers of the benchmark's own loader.
TEST(SetBenchmarkTest, Hdm05AsADataSetIsThePublishedBenchmark) {
  POISE_REQUIRE_DATA("hdm05/kickLFront1Reps");
  auto set = ReadClipFolder(testing::DataPath("hdm05"), {.action_class = "kickLFront1Reps"});
  ASSERT_TRUE(set.ok()) << set.status();
  const auto made = MakeBenchmark(std::move(set->clips), {.hold_out = "tr"});
  const auto read = LoadHdm05Benchmark(testing::DataPath("hdm05"), "kickLFront1Reps", "tr");
  ASSERT_TRUE(made.ok()) << made.status();
  ASSERT_EQ(made->train.size(), read->train.size());
  ASSERT_EQ(made->test.size(), read->test.size());
  EXPECT_EQ(made->counts, read->counts);
  EXPECT_EQ(made->sense, read->sense);
  for (size_t i = 0; i < made->test.size(); ++i) {
    const PoseMatrix a = RotationVectors(made->test[i].clip, made->sense);
    const PoseMatrix b = RotationVectors(read->test[i].clip, read->sense);
    ASSERT_EQ(a.rows(), b.rows());
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(SetBenchmarkTest, CmuAsADataSetHasThePublishedColumns) {
  POISE_REQUIRE_DATA("cmu/train");
  auto set = ReadClipFolder(testing::DataPath("cmu/train"), {});
  ASSERT_TRUE(set.ok()) << set.status();
  const auto made =
      MakeBenchmark(std::move(set->clips), {.form = {.frame_rate = 60, .body = "all"}});
  ASSERT_TRUE(made.ok()) << made.status();
  EXPECT_EQ(made->counts, LoadCmuBenchmark(testing::DataPath("cmu"))->counts);
}

}  // namespace
}  // namespace poise::motion
