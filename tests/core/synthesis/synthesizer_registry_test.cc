#include "core/synthesis/synthesizer_registry.h"

#include <gtest/gtest.h>

namespace poise::synthesis {
namespace {

Status ErrorOf(std::string_view method, const SynthesisOptions& options = {}) {
  return CreateMethod(method, options).status();
}

TEST(SynthesizerRegistryTest, EveryStepAndTheirChainsAreBuilt) {
  for (const std::string& name : MethodStepNames()) {
    const Status status = ErrorOf(name);
    EXPECT_EQ(status.ok() ? "" : base::ErrorReason(status), name == "vae" ? "MISSING_MODEL" : "")
        << name;
  }
  const auto steps = CreateMethod("ik+timewarp+noise", {});
  ASSERT_TRUE(steps.ok());
  ASSERT_EQ(steps->size(), 3u);
  EXPECT_EQ((*steps)[0].name, "ik");
  EXPECT_EQ((*steps)[2].name, "noise");
}

TEST(SynthesizerRegistryTest, AnUnknownStepNamesTheKnownOnesAndTheNearest) {
  const Status status = ErrorOf("ik+timewrap");
  EXPECT_EQ(base::ErrorReason(status), "UNKNOWN_METHOD");
  EXPECT_EQ(base::ErrorField(status), "method");
  EXPECT_NE(base::Message(status).find("did you mean 'timewarp'"), std::string::npos);
  EXPECT_NE(base::Message(status).find("mirror"), std::string::npos);
  for (const char* method : {"", "+", "ik+", "ik,noise", "IK"}) {
    EXPECT_EQ(base::ErrorReason(ErrorOf(method)), "UNKNOWN_METHOD") << method;
  }
  EXPECT_EQ(base::ErrorReason(ErrorOf("ik+ik+ik+ik+ik+ik+ik+ik+ik")), "TOO_MANY_STEPS");
}

TEST(SynthesizerRegistryTest, AnUnknownClassNamesTheKnownOnes) {
  const Status status = ErrorOf("ik", {.action_class = "kik"});
  EXPECT_EQ(base::ErrorReason(status), "UNKNOWN_ACTION_CLASS");
  EXPECT_NE(base::Message(status).find("sneak"), std::string::npos);
  EXPECT_NE(base::Message(status).find("did you mean 'kick'"), std::string::npos);
  EXPECT_EQ(base::ErrorReason(ErrorOf("ik", {.preset = "papers"})), "UNKNOWN_PRESET");
}

TEST(SynthesizerRegistryTest, OverridesReachTheirStepAndBadOnesAreRefused) {
  EXPECT_TRUE(CreateMethod("ik+timewarp",
                           {.overrides = {{"ik.angle", "0.5"}, {"timewarp.factor_low", "0.95"}}})
                  .ok());
  const auto reason = [](const char* key, const char* value) {
    const Status status = ErrorOf("ik+timewarp", {.overrides = {{key, value}}});
    EXPECT_EQ(base::ErrorField(status), key);
    return base::ErrorReason(status);
  };
  EXPECT_EQ(reason("ik.radius_hi", "1"), "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(reason("angle", "1"), "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(reason("noise.fraction", "0.1"), "UNKNOWN_CONFIG_KEY");  // not a step of this method
  EXPECT_EQ(reason("ik.angle", "wide"), "MALFORMED_CONFIG_VALUE");
  EXPECT_EQ(reason("ik.propagation", "wave"), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(reason("ik.radius_low", "3"), "CONFIG_VALUE_OUT_OF_RANGE");  // above radius_high
}

}  // namespace
}  // namespace poise::synthesis
