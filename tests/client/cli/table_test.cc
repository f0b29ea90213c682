#include "client/cli/table.h"

#include <gtest/gtest.h>

namespace poise::cli {
namespace {

TEST(TableTest, TheFirstColumnIsLeftTheOthersRight) {
  Table table({"clip", "jerk"});
  table.AddRow({"kick", "7"});
  table.AddRow({"a walk", "12345"});
  EXPECT_EQ(table.Text(),
            "clip     jerk\n"
            "-------------\n"
            "kick        7\n"
            "a walk  12345");
}

TEST(TableTest, LettersOfSeveralBytesTakeOnePlace) {
  Table table({"x", "m/s²"});
  table.AddRow({"é", "12.5"});
  EXPECT_EQ(table.Text(),
            "x  m/s²\n"
            "-------\n"
            "é  12.5");
}

TEST(TableTest, AShortRowLeavesItsLastCellsEmpty) {
  Table table({"a", "b"});
  table.AddRow({"only"});
  EXPECT_EQ(table.Text(), "a     b\n-------\nonly");
}

}  // namespace
}  // namespace poise::cli
