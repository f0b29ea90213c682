#include "proto/convert/predict_convert.h"

#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::convert {
namespace {

TEST(PredictConvertTest, QuerySurvivesTheRoundTrip) {
  const api::PredictQuery query{.source = {poise::testing::SwingingClip(2), {{"tail", "tip"}}},
                                .model = "gcn@3",
                                .horizon_s = 1.5,
                                .visible = {std::vector<bool>(42, true)},
                                .samples = 7,
                                .seed = ~uint64_t{0},
                                .output = api::OutputEncoding::kBvh};
  const auto back = FromProto(ToProto(query));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(std::get<motion::Clip>(back->source.clip).num_frames(), 2);
  EXPECT_EQ(back->source.joint_roles, query.source.joint_roles);
  EXPECT_EQ(back->model, "gcn@3");
  EXPECT_EQ(back->horizon_s, 1.5);
  EXPECT_EQ(back->visible.visible, query.visible.visible);
  EXPECT_EQ(back->samples, 7);
  EXPECT_EQ(back->seed, query.seed);
  EXPECT_EQ(back->output, api::OutputEncoding::kBvh);
}

TEST(PredictConvertTest, AbsentFieldsTakeTheDefaults) {
  v1::PredictRequest request;
  *request.mutable_source() =
      ToProto(api::PredictQuery{.source = {poise::testing::SwingingClip(2), {}}}).source();
  const auto query = FromProto(request);
  ASSERT_TRUE(query.ok()) << query.status();
  EXPECT_EQ(query->model, "zero-velocity");
  EXPECT_EQ(query->horizon_s, 0.4);
  EXPECT_EQ(query->samples, 1);
  EXPECT_TRUE(query->visible.empty());
  EXPECT_EQ(query->output, api::OutputEncoding::kArrays);
}

TEST(PredictConvertTest, ForecastSurvivesTheRoundTrip) {
  api::Forecast forecast{.model = "m",
                         .version = "4",
                         .frame_times_s = {0.1, 0.2},
                         .futures = {},
                         .deterministic = false,
                         .inpainted = true};
  forecast.futures.emplace_back(poise::testing::SwingingClip(2));
  forecast.futures.emplace_back(poise::testing::SwingingClip(2));
  const auto back = FromProto(ToProto(forecast));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->model, "m");
  EXPECT_EQ(back->version, "4");
  EXPECT_EQ(back->frame_times_s, forecast.frame_times_s);
  EXPECT_EQ(back->futures.size(), 2u);
  EXPECT_FALSE(back->deterministic);
  EXPECT_TRUE(back->inpainted);
}

TEST(PredictConvertTest, StreamSetupAndFramesSurviveTheRoundTrip) {
  const motion::Clip clip = poise::testing::SwingingClip(3);
  const api::ForecastStreamSpec spec{.model = "m",
                                     .horizon_s = 0.2,
                                     .skeleton = clip.skeleton(),
                                     .frame_rate = 120,
                                     .joint_roles = {{"left_hip", "l"}}};
  const auto back = FromProto(ToProto(spec));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->model, "m");
  EXPECT_EQ(back->horizon_s, 0.2);
  EXPECT_TRUE(back->skeleton->SameAs(*clip.skeleton()));
  EXPECT_EQ(back->joint_roles, spec.joint_roles);
  const auto frames = FromProto(ToObservedFrames(clip), back->skeleton, back->frame_rate);
  ASSERT_TRUE(frames.ok());
  EXPECT_EQ(frames->num_frames(), 3);
  EXPECT_LT(math::GeodesicDistance(frames->rotation(2, 4), clip.rotation(2, 4)), 1e-5);
}

}  // namespace
}  // namespace poise::convert
