// correction.proto is the schema of JSON that core/api writes and reads: neither may know a field
// that the other does not.
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "core/api/correct_spec.h"
#include "core/api/correction_report.h"
#include "poise/v1/correction.pb.h"

namespace poise::convert {
namespace {

using google::protobuf::util::JsonStringToMessage;

std::string JsonOf(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  std::string json;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(message, &json, options).ok());
  return json;
}

TEST(CorrectionSchemaTest, ASpecWithEveryFieldGoesBothWays) {
  api::CorrectSpec spec;
  spec.sources = {
      {.clip =
           api::StoredClip{.artifact = "artifacts/12",
                           .name = "a.bvh",
                           .format = motion::ClipFormat::kBvh,
                           .skeleton_data = ":version",
                           .hints = {.unit_m = 0.01, .up = motion::UpAxis::kZ, .frame_rate = 60}},
       .joint_roles = {{"left_hip", "Hip_L"}}}};
  spec.model = "kick@2";
  spec.model_artifact = "artifacts/34";
  spec.debias = "kick-tr@1";
  spec.debias_artifact = "artifacts/56";
  spec.variants_per_source = 3;
  spec.effort = "full";
  spec.residual = "rfc";
  spec.max_seconds = 60;
  spec.body_mass_kg = 80;
  spec.overrides = {{"learning.rollouts", "3"}};
  v1::CorrectSpec message;
  const auto status = JsonStringToMessage(spec.ToJson().dump(), &message);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(message.sources(0).up(), "z");
  const auto back = api::CorrectSpec::FromJson(base::Json::parse(JsonOf(message)));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->ToJson().dump(), spec.ToJson().dump());
}

TEST(CorrectionSchemaTest, AReportWithEveryFieldIsRead) {
  api::CorrectedVariantReport good;
  good.file = "kick_ik_000.bvh";
  good.seed = 18446744073709551615u;
  good.completed = true;
  good.effort = "fast";
  good.after.emplace();
  good.after->score.residual_force_peak_bw = 0.25;
  api::CorrectedVariantReport bad;
  bad.error = api::JobError{absl::StatusCode::kOutOfRange, "DIVERGED", "it flew away", ""};
  const api::CorrectedClipReport report{.name = "kick",
                                        .samples = 7,
                                        .stopped_by = "finished",
                                        .zero_policy = api::ZeroPolicyReport(),
                                        .reward_curve = {{.samples = 7}},
                                        .variants = {good, bad}};
  v1::CorrectionReport message;
  const base::Json json = {{"clips", {api::ToJson(report)}}};
  const auto status = JsonStringToMessage(json.dump(), &message);
  ASSERT_TRUE(status.ok()) << status.ToString();
  EXPECT_EQ(message.clips(0).variants(0).seed(), 18446744073709551615u);
  EXPECT_EQ(message.clips(0).variants(0).after().residual_force_peak_bw(), 0.25);
  EXPECT_FALSE(message.clips(0).variants(1).has_after());
  EXPECT_EQ(message.clips(0).variants(1).error().reason(), "DIVERGED");
  // Every field of the simulation's measures is in the report.
  const auto* fields = v1::CorrectionMeasures::descriptor();
  const base::Json zero = api::ToJson(report)["zero_policy"];
  for (int i = 0; i < fields->field_count(); ++i) {
    EXPECT_TRUE(zero.contains(fields->field(i)->name())) << fields->field(i)->name();
  }
}

}  // namespace
}  // namespace poise::convert
