#include "proto/convert/model_convert.h"

#include <gtest/gtest.h>

#include "proto/convert/data_convert.h"

namespace poise::convert {
namespace {

api::Model MadeModel() {
  api::Model model;
  model.name = "kick";
  model.version = "3";
  model.size_bytes = int64_t{1} << 40;
  model.is_default = true;
  model.shipped = true;
  api::ModelCard& card = model.card;
  card.family = "vae";
  card.preset = "paper";
  card.config = {{"beta", 0.01}, {"latent", 128}};
  card.signature = {.roles = {motion::JointRole::kPelvis, motion::JointRole::kLeftToe},
                    .rotation = motion::RotationRepresentation::kExponentialMap,
                    .with_root_position = false,
                    .frame_rate = 60};
  card.normalisation = {{"mean", {0.5, -2}}};
  card.data = "hdm05";
  card.data_fingerprint = "abc";
  card.trained_on = "class kick";
  card.data_license = "CC BY-SA 3.0";
  card.seed = ~uint64_t{0};
  card.steps = 20000;
  card.scores = {{"mmd", 0.125}, {"min_dtw", 2.5}};
  card.program_version = "0.1.0";
  card.weights_sha256 = "def";
  return model;
}

TEST(ModelConvertTest, EveryFieldOfAModelSurvivesTheWire) {
  v1::Model parsed;
  ASSERT_TRUE(parsed.ParseFromString(ToProto(MadeModel()).SerializeAsString()));
  const auto model = FromProto(parsed);
  ASSERT_TRUE(model.ok()) << model.status();
  EXPECT_EQ(api::ToJson(*model), api::ToJson(MadeModel()));
}

TEST(ModelConvertTest, AnUnknownRoleIsRefused) {
  v1::Model message = ToProto(MadeModel());
  message.mutable_card()->mutable_signature()->add_roles("tail");
  EXPECT_EQ(base::ErrorReason(FromProto(message).status()), "UNKNOWN_ROLE");
}

TEST(DataConvertTest, EveryFieldOfADataSetSurvivesTheWire) {
  api::DataSet set;
  set.name = "hdm05";
  set.artifact = "artifacts/0123";
  set.size_bytes = int64_t{1} << 40;
  set.clips = 3;
  set.frames = 1000;
  set.duration_s = 8.25;
  set.actions = {{"kick", 2}, {"jog", 1}};
  set.actors = {{"bd", 3}};
  set.license = "mine";
  set.notes = {"retargeted"};
  set.create_time = absl::FromUnixSeconds(1'700'000'000);
  EXPECT_EQ(FromProto(ToProto(set)), set);
  EXPECT_EQ(set.fingerprint(), "0123");
  EXPECT_EQ(*api::DataSetFromJson(api::ToJson(set)), set);
}

}  // namespace
}  // namespace poise::convert
