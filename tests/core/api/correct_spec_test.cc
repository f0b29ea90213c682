#include "core/api/correct_spec.h"

#include <gtest/gtest.h>

namespace poise::api {
namespace {

using base::Json;

Json Minimal() { return {{"sources", {{{"artifact", "artifacts/ab"}, {"name", "kick.bvh"}}}}}; }

// Reason and field of what Minimal() with `more` is refused for.
std::pair<std::string, std::string> Refusal(const Json& more) {
  Json json = Minimal();
  json.update(more);
  const Status status = CorrectSpec::FromJson(json).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  return {base::ErrorReason(status), base::ErrorField(status)};
}

TEST(CorrectSpecTest, JsonKeepsEveryField) {
  CorrectSpec spec;
  spec.sources = {
      {.clip =
           StoredClip{.artifact = "artifacts/12",
                      .name = "a.bvh",
                      .format = motion::ClipFormat::kBvh,
                      .skeleton_data = ":version 1.10\n",
                      .hints = {.unit_m = 0.01, .up = motion::UpAxis::kZ, .frame_rate = 119.98}},
       .joint_roles = {{"left_hip", "LeftUpLeg"}}}};
  spec.method = "ik+timewarp";
  spec.action_class = "jog";
  spec.variants_per_source = 3;
  spec.effort = "full";
  spec.preset = "paper";
  spec.residual = "pd_rfc";
  spec.max_seconds = 12.5;
  spec.body_mass_kg = 70;
  spec.overrides = {{"learning.rollouts", "4"}, {"ik.radius_low", "0.9"}};
  const auto back = CorrectSpec::FromJson(spec.ToJson());
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->ToJson().dump(), spec.ToJson().dump());
  const auto& stored = std::get<StoredClip>(back->sources[0].clip);
  EXPECT_EQ(stored.hints.frame_rate, 119.98);
  EXPECT_EQ(stored.hints.up, motion::UpAxis::kZ);
  EXPECT_EQ(back->sources[0].joint_roles.at("left_hip"), "LeftUpLeg");
  EXPECT_EQ(back->overrides, spec.overrides);
}

TEST(CorrectSpecTest, WhatIsLeftOutHasItsDefault) {
  const auto spec = CorrectSpec::FromJson(Minimal());
  ASSERT_TRUE(spec.ok()) << spec.status();
  EXPECT_EQ(spec->method, "ik");
  EXPECT_EQ(spec->effort, "fast");
  EXPECT_EQ(spec->Variants(), 20);
  Json none = Minimal();
  none["method"] = "none";
  EXPECT_EQ(CorrectSpec::FromJson(none)->Variants(), 1);
}

TEST(CorrectSpecTest, MistakesAreNamedWithTheirField) {
  using Pair = std::pair<std::string, std::string>;
  EXPECT_EQ(Refusal({{"sources", Json::array()}}), Pair("EMPTY_REQUEST", "sources"));
  EXPECT_EQ(Refusal({{"sources", {{{"name", "a"}}}}}), Pair("MALFORMED_SOURCE", "sources[0]"));
  EXPECT_EQ(Refusal({{"sources", 3}}), Pair("MALFORMED_SOURCE", "sources"));
  EXPECT_EQ(Refusal({{"sources", {{{"artifact", "a"}, {"name", "b"}, {"up", "x"}}}}}).second,
            "sources[0].up");
  EXPECT_EQ(Refusal({{"efort", "fast"}}), Pair("UNKNOWN_CONFIG_KEY", "efort"));
  EXPECT_EQ(Refusal({{"effort", "slow"}}).second, "effort");
  EXPECT_EQ(Refusal({{"preset", "best"}}).second, "preset");
  EXPECT_EQ(Refusal({{"residual", "wires"}}).second, "residual");
  EXPECT_EQ(Refusal({{"variants_per_source", -1}}).second, "variants_per_source");
  EXPECT_EQ(Refusal({{"max_seconds", -1}}).second, "max_seconds");
  EXPECT_EQ(Refusal({{"body_mass_kg", 2}}), Pair("CONFIG_VALUE_OUT_OF_RANGE", "body_mass_kg"));
  EXPECT_EQ(Refusal({{"overrides", "x"}}).second, "overrides");
  EXPECT_EQ(Refusal({{"method", "none"}, {"variants_per_source", 2}}),
            Pair("BAD_VARIANT_COUNT", "variants_per_source"));
  EXPECT_EQ(Refusal({{"residual", "rfc"}}), Pair("RESIDUAL_NEEDS_LEARNING", "residual"));
  EXPECT_FALSE(CorrectSpec::FromJson(Json::array()).ok());
}

}  // namespace
}  // namespace poise::api
