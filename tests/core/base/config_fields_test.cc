#include "core/base/config_fields.h"

#include <gtest/gtest.h>

namespace poise::base {
namespace {

struct ExampleConfig {
  double tolerance = 1e-4;
  int iterations = 50;
  bool clamp = true;
  std::string rule = "paper";

  std::vector<Field> Fields() {
    return {Number("tolerance", &tolerance, 1e-9, 1), Number("iterations", &iterations, 1, 1000),
            Flag("clamp", &clamp), Text("rule", &rule, {"paper", "window"})};
  }
};

TEST(ConfigFieldsTest, OverridesSetEveryKindOfField) {
  ExampleConfig config;
  ASSERT_TRUE(
      ApplyOverrides(
          {{"tolerance", "0.01"}, {"iterations", "7"}, {"clamp", "false"}, {"rule", "window"}},
          config.Fields())
          .ok());
  EXPECT_EQ(config.tolerance, 0.01);
  EXPECT_EQ(config.iterations, 7);
  EXPECT_FALSE(config.clamp);
  EXPECT_EQ(config.rule, "window");
}

TEST(ConfigFieldsTest, AnUnknownKeyNamesTheNearestKnownOne) {
  ExampleConfig config;
  const Status status = ApplyOverrides({{"tolerence", "1"}}, config.Fields());
  EXPECT_EQ(ErrorReason(status), "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(ErrorField(status), "tolerence");
  EXPECT_NE(base::Message(status).find("'tolerance'"), std::string::npos);
}

TEST(ConfigFieldsTest, BadValuesAreRefusedWithTheKey) {
  ExampleConfig config;
  for (const auto& [key, value] : Overrides{
           {"tolerance", "nan"}, {"iterations", "0"}, {"clamp", "perhaps"}, {"rule", "author"}}) {
    const Status status = ApplyOverrides({{key, value}}, config.Fields());
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << key;
    EXPECT_EQ(ErrorField(status), key);
  }
}

TEST(ConfigFieldsTest, JsonRoundTripKeepsEveryValue) {
  ExampleConfig config;
  config.tolerance = 0.125;
  config.rule = "window";
  const Json json = FieldsToJson(Nested("fabrik", config.Fields()));
  ExampleConfig copy;
  ASSERT_TRUE(FieldsFromJson(json, Nested("fabrik", copy.Fields())).ok());
  EXPECT_EQ(copy.tolerance, 0.125);
  EXPECT_EQ(copy.rule, "window");
}

}  // namespace
}  // namespace poise::base
