#include "core/motion/dataset/windows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/motion/dataset/legacy_random.h"

namespace poise::motion {
namespace {

using ::testing::ElementsAre;
using Starts = std::vector<int>;

TEST(LegacyRandomTest, FirstOutputsAreThoseOfNumpy) {
  LegacyRandom random(1234567890);
  for (const uint32_t expected : {2657703298u, 1462474751u, 2541004134u, 640082991u, 3816866956u,
                                  998313779u, 3829628193u, 1854614443u}) {
    EXPECT_EQ(random.Next(), expected);
  }
}

TEST(LegacyRandomTest, ARangeOfOneValueDrawsNothing) {
  LegacyRandom random(1234567890);
  EXPECT_EQ(random.Integer(7, 8), 7);
  EXPECT_EQ(random.Next(), 2657703298u);
}

TEST(LegacyRandomTest, EveryValueOfARangeComesAndNoOther) {
  LegacyRandom random(5);
  std::set<int> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random.Integer(-3, 6));
  EXPECT_EQ(seen.size(), 9u);
  EXPECT_EQ(*seen.begin(), -3);
  EXPECT_EQ(*seen.rbegin(), 5);
}

// Reference sec. 1.7: decimated lengths of the CMU test files, total 60 and total 75.
TEST(SeededStartsTest, AreThePublishedOnesForShortAndLongWindows) {
  const struct {
    int frames;
    Starts total60, total75;
  } cases[] = {
      {289, {130, 102, 47, 140, 51, 33, 171, 105}, {130, 102, 47, 140, 51, 33, 171, 105}},
      {1043, {386, 358, 47, 140, 819, 289, 939, 105}, {386, 358, 47, 140, 819, 289, 939, 105}},
      {82, {2, 6, 15, 12, 19, 1, 11, 9}, {2, 6, 4, 3, 1, 3, 1, 4}},
      {299, {130, 102, 47, 140, 51, 33, 171, 105}, {130, 102, 47, 140, 51, 33, 171, 105}},
      {180, {2, 102, 47, 12, 51, 33, 43, 105}, {2, 102, 47, 12, 51, 33, 43, 60}},
      {1377,
       {1071, 1164, 1313, 939, 1129, 316, 644, 288},
       {1071, 1164, 939, 1129, 316, 644, 288, 185}},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(*SeededStarts(c.frames, 60), c.total60) << c.frames;
    EXPECT_EQ(*SeededStarts(c.frames, 75), c.total75) << c.frames;
  }
}

// Reference sec. 1.7, ACCAD: total 100.
TEST(SeededStartsTest, AreThePublishedOnesForAccad) {
  EXPECT_EQ(*SeededStarts(286, 100), (Starts{130, 102, 47, 140, 51, 33, 171, 105}));
  EXPECT_EQ(*SeededStarts(193, 100), (Starts{2, 47, 12, 51, 33, 43, 60, 14}));
  EXPECT_EQ(*SeededStarts(637, 100), (Starts{386, 358, 47, 140, 289, 105, 316, 398}));
  EXPECT_EQ(*SeededStarts(115, 100), (Starts{2, 6, 12, 3, 1, 11, 9, 12}));
}

TEST(SeededStartsTest, SequenceOfTheWindowsLengthIsRefused) {
  EXPECT_EQ(base::ErrorReason(SeededStarts(75, 75).status()), "CLIP_TOO_SHORT");
  EXPECT_EQ(*SeededStarts(76, 75), Starts(8, 0));
}

TEST(AllStartsTest, LastWindowEndsAtTheLastFrame) {
  EXPECT_THAT(AllStarts(38, 35), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(AllStarts(35, 35), ElementsAre(0));
  EXPECT_THAT(AllStarts(34, 35), ElementsAre());
}

TEST(FindProtocolTest, KnowsThePublishedOnesAndNamesThemWhenAskedForAnother) {
  EXPECT_EQ(FindProtocol("seeded60")->window, (WindowShape{50, 10}));
  EXPECT_EQ(FindProtocol("seeded75")->window.total(), 75);
  EXPECT_EQ(FindProtocol("loso")->window, (WindowShape{12, 12}));
  const Status unknown = FindProtocol("seeded90").status();
  EXPECT_EQ(base::ErrorReason(unknown), "UNKNOWN_PROTOCOL");
  EXPECT_THAT(base::Message(unknown), ::testing::HasSubstr("seeded60, seeded75, all, loso"));
}

TEST(TestStartsTest, SeededProtocolsDrawEightAndOthersTakeAll) {
  EXPECT_EQ(TestStarts(*FindProtocol("seeded75"), 82)->size(), 8u);
  EXPECT_EQ(TestStarts(*FindProtocol("all"), 82)->size(), 8u);
  EXPECT_EQ(TestStarts(*FindProtocol("all"), 83)->size(), 9u);
}

}  // namespace
}  // namespace poise::motion
