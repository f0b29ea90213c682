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

TEST(JsonTest, AWholeNumberIsTakenOnlyWhereItFits) {
  EXPECT_EQ(IntegerFrom<int>(Json(7)), 7);
  EXPECT_EQ(IntegerFrom<int>(Json(-7)), -7);
  EXPECT_EQ(IntegerFrom<uint64_t>(Json(UINT64_MAX)), UINT64_MAX);
  EXPECT_THROW(IntegerFrom<int64_t>(Json(UINT64_MAX)), Json::type_error);
  EXPECT_THROW(IntegerFrom<uint64_t>(Json(-1)), Json::type_error);
  EXPECT_THROW(IntegerFrom<int>(Json(int64_t{1} << 31)), Json::type_error);
  EXPECT_THROW(IntegerFrom<int>(Json(1e300)), Json::type_error);
  EXPECT_THROW(IntegerFrom<int>(Json("7")), Json::type_error);
}

}  // namespace
}  // namespace poise::base
