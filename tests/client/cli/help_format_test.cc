#include "client/cli/help_format.h"

#include <gtest/gtest.h>

namespace poise::cli {
namespace {

TEST(HelpFormatTest, LinesBreakBetweenWords) {
  EXPECT_EQ(Wrap("one two three", 7), "one two\nthree");
  EXPECT_EQ(Wrap("one two three", 6), "one\ntwo\nthree");
  EXPECT_EQ(Wrap("extraordinary", 5), "extraordinary");
  EXPECT_EQ(Wrap("", 5), "");
}

TEST(HelpFormatTest, LineEndsOfTheTextStay) {
  EXPECT_EQ(Wrap("one\n\ntwo three", 9), "one\n\ntwo three");
}

}  // namespace
}  // namespace poise::cli
