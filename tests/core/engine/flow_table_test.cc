#include "core/engine/flow_table.h"

#include <gtest/gtest.h>

#include <set>

namespace poise::engine {
namespace {

TEST(FlowTableTest, EveryKindIsThereOnceAndMakesItsRunnerIfItNeedsNoLibTorch) {
  std::set<std::string_view> kinds;
  for (const Flow& flow : FlowTable()) {
    EXPECT_TRUE(kinds.insert(flow.kind).second) << flow.kind;
    EXPECT_FALSE(flow.summary.empty()) << flow.kind;
    const bool needs_libtorch = flow.make_runner == nullptr;
    EXPECT_TRUE(needs_libtorch || flow.make_runner() != nullptr) << flow.kind;
    EXPECT_FALSE(flow.validate({{"no such parameter", 1}}).ok()) << flow.kind;
  }
  EXPECT_EQ((*FindFlow("selftest"))->kind, "selftest");
}

TEST(FlowTableTest, OnlyJobsThatLearnNeedLibTorch) {
  const base::Json source = {{"artifact", "artifacts/0"}, {"name", "kick.bvh"}};
  const auto correct = [&](const char* effort) {
    return NeedsTorch(
        {.kind = "correct", .parameters = {{"sources", {source}}, {"effort", effort}}});
  };
  EXPECT_FALSE(correct("instant"));
  EXPECT_FALSE(correct("fast"));
  EXPECT_TRUE(correct("full"));
  EXPECT_TRUE(NeedsTorch(
      {.kind = "correct",
       .parameters = {
           {"sources", {source}}, {"method", "vae"}, {"model_artifact", "artifacts/1"}}}));
  EXPECT_FALSE(NeedsTorch(
      {.kind = "correct",
       .parameters = {
           {"sources", {source}}, {"effort", "fast"}, {"debias_artifact", "artifacts/1"}}}));
  EXPECT_FALSE(NeedsTorch({.kind = "selftest", .parameters = {}}));
  EXPECT_TRUE(NeedsTorch({.kind = "train_vae", .parameters = {}}));
  EXPECT_TRUE(NeedsTorch({.kind = "train_push", .parameters = {}}));
  EXPECT_FALSE(
      NeedsTorch({.kind = "evaluate_push", .parameters = {{"data_artifact", "artifacts/0"}}}));
  EXPECT_TRUE(NeedsTorch(
      {.kind = "evaluate_push",
       .parameters = {{"data_artifact", "artifacts/0"}, {"model_artifact", "artifacts/1"}}}));
  EXPECT_TRUE(NeedsTorch({.kind = "train_predictor", .parameters = {}}));
  EXPECT_FALSE(NeedsTorch({.kind = "evaluate_predictor", .parameters = {}}));
  EXPECT_TRUE(NeedsTorch({.kind = "train_debias", .parameters = {}}));
  EXPECT_FALSE(NeedsTorch({.kind = "nonsense", .parameters = {}}));
  EXPECT_EQ(base::ErrorReason(MakeLightRunner("train_vae").status()), "NO_NETWORKS");
  EXPECT_TRUE(MakeLightRunner("correct").ok());
}

TEST(FlowTableTest, UnknownKindIsRefusedWithTheKnownOnes) {
  const Status status = FindFlow("selftset").status();
  EXPECT_EQ(base::ErrorReason(status), "UNKNOWN_JOB_KIND");
  EXPECT_EQ(base::ErrorField(status), "spec.kind");
  EXPECT_NE(base::Message(status).find("selftest"), std::string::npos);
}

TEST(FlowTableTest, ParametersAreCheckedWithTheFieldToBlame) {
  const Flow& selftest = **FindFlow("selftest");
  const Status unknown = selftest.validate({{"stps", 3}});
  EXPECT_EQ(base::ErrorReason(unknown), "UNKNOWN_CONFIG_KEY");
  EXPECT_EQ(base::ErrorField(unknown), "spec.parameters.stps");
  EXPECT_EQ(base::ErrorField(selftest.validate({{"steps", -1}})), "spec.parameters.steps");
  EXPECT_EQ(base::ErrorField(selftest.validate({{"steps", 1.5}})), "spec.parameters.steps");
  EXPECT_EQ(base::ErrorField(selftest.validate({{"failure", "sulk"}})), "spec.parameters.failure");
  EXPECT_FALSE(selftest.validate({{"steps", {{"a", 1}}}}).ok());
  EXPECT_FALSE(selftest.validate(base::Json::array()).ok());
  EXPECT_TRUE(selftest.validate({{"steps", 3}, {"busy", true}, {"failure", "diverge"}}).ok());
}

TEST(FlowTableTest, ParametersOfPredictorsAreCheckedBeforeAnythingRuns) {
  const base::Json data = {{"data_artifact", "artifacts/0"}};
  const auto reason = [&](const char* kind, const char* key, base::Json value) {
    base::Json parameters = data;
    if (*key != 0) parameters[key] = std::move(value);
    return base::ErrorReason((*FindFlow(kind))->validate(parameters));
  };
  EXPECT_TRUE((*FindFlow("train_predictor"))->validate(data).ok());
  EXPECT_TRUE((*FindFlow("evaluate_predictor"))->validate(data).ok());
  EXPECT_EQ(reason("train_predictor", "preset", "best"), "UNKNOWN_PRESET");
  EXPECT_EQ(reason("train_predictor", "body", "half"), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(reason("train_predictor", "frame_rate", -1), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(reason("train_predictor", "name", "no name"), "BAD_MODEL_NAME");
  EXPECT_EQ(reason("train_predictor", "set", {{"members", 0}}), "CONFIG_VALUE_OUT_OF_RANGE");
  EXPECT_EQ(reason("evaluate_predictor", "protocol", "seeded90"), "UNKNOWN_PROTOCOL");
  EXPECT_EQ(reason("evaluate_predictor", "data_artifact", ""), "MISSING_DATA");
}

}  // namespace
}  // namespace poise::engine
