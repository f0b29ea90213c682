#include "client/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace poise::cli {
namespace {

TEST(ProgressBarTest, TheBarShowsShareRateAndTimeLeft) {
  EXPECT_EQ(ProgressBar::Text(100, 400, "variants", absl::Seconds(4)),
            "[#######.......................]  100/400 variants  25/s  0:12 left");
}

TEST(ProgressBarTest, NothingDoneYetHasNoRate) {
  EXPECT_EQ(ProgressBar::Text(0, 4, "variants", absl::Seconds(1)),
            "[..............................]  0/4 variants");
}

TEST(ProgressBarTest, WithoutATerminalEveryTenthIsALine) {
  ::testing::internal::CaptureStderr();
  {
    ProgressBar bar(ProgressBar::Style::kLines, 20, "variants");
    for (int i = 1; i <= 20; ++i) bar.Update(i);
  }
  const std::string lines = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 10);
  EXPECT_EQ(lines.find('\r'), std::string::npos);
  EXPECT_EQ(lines.substr(0, 18), "2 of 20 variants\n4");
}

TEST(ProgressBarTest, ABarLeavesNothingOnTheScreen) {
  ::testing::internal::CaptureStderr();
  {
    ProgressBar bar(ProgressBar::Style::kBar, 2, "variants");
    bar.Update(2);
  }
  const std::string drawn = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(drawn.find("2/2 variants"), std::string::npos);
  EXPECT_TRUE(drawn.ends_with("\r\x1b[K"));
}

}  // namespace
}  // namespace poise::cli
