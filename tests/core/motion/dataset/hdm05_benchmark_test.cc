#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/dataset/benchmark_clips.h"
#include "tests/support/data_files.h"

namespace poise::motion {
namespace {

using ::testing::ElementsAre;
constexpr char kKick[] = "kickLFront1Reps";

TEST(Hdm05BenchmarkTest, ActorLeftOutIsTheTestAndNobodyIsInBoth) {
  POISE_REQUIRE_DATA("hdm05");
  const auto folder = testing::DataPath("hdm05");
  EXPECT_THAT(*Hdm05Actors(folder, kKick), ElementsAre("bd", "bk", "dg", "mm", "tr"));
  const auto clips = LoadHdm05Benchmark(folder, kKick, "tr");
  ASSERT_TRUE(clips.ok()) << clips.status();
  EXPECT_EQ(clips->test.size(), 4u);
  EXPECT_EQ(clips->train.size(), 24u);
  for (const LabelledClip& clip : clips->test) EXPECT_EQ(clip.actor, "tr");
  for (const LabelledClip& clip : clips->train) EXPECT_NE(clip.actor, "tr");
  EXPECT_EQ(clips->test.front().clip.frame_rate(), 30);
  EXPECT_EQ(clips->test.front().clip.num_joints(), 16);
  EXPECT_EQ(clips->counts.size(), 48u);
}

TEST(Hdm05BenchmarkTest, ActorWithoutClipsIsRefusedWithThoseThereAre) {
  POISE_REQUIRE_DATA("hdm05");
  const Status status = LoadHdm05Benchmark(testing::DataPath("hdm05"), kKick, "xx").status();
  EXPECT_EQ(base::ErrorReason(status), "NO_CLIPS");
  EXPECT_NE(base::Message(status).find("bd, bk, dg, mm, tr"), std::string::npos);
}

}  // namespace
}  // namespace poise::motion
