#include "core/base/json.h"

#include <gtest/gtest.h>

namespace poise::base {
namespace {

TEST(JsonTest, AnErrorNamesTheTextAndTheByte) {
  const auto json = ParseJson("{\"a\": 1,]", "scene.json");
  EXPECT_EQ(ErrorReason(json.status()), "MALFORMED_JSON");
  EXPECT_EQ(Message(json.status()), "scene.json: not JSON at byte 9");
}

TEST(JsonTest, KeysKeepTheOrderOfTheText) {
  EXPECT_EQ(ParseJson(R"({"b": 1, "a": 2})", "x")->dump(), R"({"b":1,"a":2})");
}

TEST(JsonTest, ANumberOutOfRangeIsAnErrorAndNoException) {
  const auto json = ParseJson("{\"a\": 1e999}", "settings");
  EXPECT_EQ(ErrorReason(json.status()), "MALFORMED_JSON");
  EXPECT_NE(Message(json.status()).find("settings"), std::string::npos);
}

}  // namespace
}  // namespace poise::base
