#include "client/cli/jobs/live_lines.h"

#include <gtest/gtest.h>

namespace poise::cli {
namespace {

TEST(LiveLinesTest, LinesThatAreTooLongAreCutBetweenCharacters) {
  EXPECT_EQ(LiveLines::Fit("abcdef\nab", 4, 10), "abcd\nab");
  EXPECT_EQ(LiveLines::Fit("äöüß", 3, 10), "äöü");
}

TEST(LiveLinesTest, WhatDoesNotFitIsCounted) {
  EXPECT_EQ(LiveLines::Fit("1\n2\n3", 40, 3), "1\n2\n3");
  EXPECT_EQ(LiveLines::Fit("1\n2\n3\n4", 40, 3), "1\n2\n... and 2 more");
  EXPECT_EQ(LiveLines::Fit("1\n2", 40, 1), "... and 2 more");
}

}  // namespace
}  // namespace poise::cli
