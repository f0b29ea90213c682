#include "proto/convert/utf8.h"

#include <gtest/gtest.h>

namespace poise::convert {
namespace {

TEST(Utf8Test, ValidTextStaysAsItIs) {
  for (const std::string text : {"", "LeftUpLeg",
                                 "H\xc3\xbc"
                                 "fte",
                                 "\xe8\x85\xb0", "\xf0\x9f\xa6\xb5"}) {
    EXPECT_EQ(ValidUtf8(text), text);
  }
}

TEST(Utf8Test, EveryInvalidByteBecomesAQuestionMark) {
  EXPECT_EQ(ValidUtf8("H\xfc"
                      "fte"),
            "H?fte");                                // Latin-1
  EXPECT_EQ(ValidUtf8("\xe8\x85"), "??");            // cut short
  EXPECT_EQ(ValidUtf8("\xc0\xaf"), "??");            // overlong
  EXPECT_EQ(ValidUtf8("\xed\xa0\x80"), "???");       // surrogate
  EXPECT_EQ(ValidUtf8("\xf4\x90\x80\x80"), "????");  // above U+10FFFF
}

}  // namespace
}  // namespace poise::convert
