#include "proto/convert/augment_convert.h"

#include <gtest/gtest.h>

#include "proto/convert/clip_convert.h"
#include "tests/support/test_clips.h"

namespace poise::convert {
namespace {

api::AugmentSpec FullSpec() {
  api::AugmentSpec spec;
  spec.sources.push_back({poise::testing::SwingingClip(3), {}});
  spec.method = "mirror+ik";
  spec.action_class = "punch";
  spec.preset = "paper";
  spec.variants_per_source = 17;
  spec.seed = ~uint64_t{0};
  spec.overrides = {{"ik.radius_low", "0.9"}};
  spec.with_plausibility = false;
  spec.output = api::OutputEncoding::kBvh;
  return spec;
}

TEST(AugmentConvertTest, SpecSurvivesTheRoundTrip) {
  const api::AugmentSpec spec = FullSpec();
  const StatusOr<api::AugmentSpec> back = FromProto(ToProto(spec));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->sources.size(), 1u);
  EXPECT_EQ(back->method, spec.method);
  EXPECT_EQ(back->action_class, spec.action_class);
  EXPECT_EQ(back->preset, spec.preset);
  EXPECT_EQ(back->variants_per_source, 17);
  EXPECT_EQ(back->seed, spec.seed);
  EXPECT_EQ(back->overrides, spec.overrides);
  EXPECT_FALSE(back->with_plausibility);
  EXPECT_EQ(back->output, api::OutputEncoding::kBvh);
}

TEST(AugmentConvertTest, AbsentFieldsTakeTheDefaults) {
  v1::AugmentRequest request;
  *request.add_sources() = ToProto(api::ClipSource{poise::testing::SwingingClip(3), {}});
  const api::AugmentSpec spec = *FromProto(request);
  EXPECT_EQ(spec.method, "ik+timewarp");
  EXPECT_EQ(spec.preset, "recommended");
  EXPECT_EQ(spec.action_class, "kick");
  EXPECT_EQ(spec.variants_per_source, 10);
  EXPECT_TRUE(spec.with_plausibility);
  EXPECT_EQ(spec.output, api::OutputEncoding::kArrays);
}

TEST(AugmentConvertTest, ErrorsNameTheSourceAndTheField) {
  v1::AugmentRequest request = ToProto(FullSpec());
  *request.add_sources() = request.sources(0);
  request.mutable_sources(1)->mutable_clip()->add_rotations(1);
  const Status status = FromProto(request).status();
  EXPECT_EQ(base::ErrorReason(status), "WRONG_SHAPE");
  EXPECT_EQ(base::ErrorField(status), "sources[1].clip.rotations");
}

TEST(AugmentConvertTest, EachBadRequestHasItsReason) {
  const auto reason_after = [](auto change) {
    v1::AugmentRequest request = ToProto(FullSpec());
    change(request);
    return base::ErrorReason(FromProto(request).status());
  };
  using Request = v1::AugmentRequest;
  EXPECT_EQ(reason_after([](Request& r) { r.clear_sources(); }), "EMPTY_REQUEST");
  EXPECT_EQ(reason_after([](Request& r) {
              for (int i = 0; i < 1000; ++i) r.add_sources();
            }),
            "TOO_MANY_SOURCES");
  EXPECT_EQ(reason_after([](Request& r) { r.set_variants_per_source(-1); }), "BAD_VARIANT_COUNT");
  EXPECT_EQ(reason_after([](Request& r) { r.set_variants_per_source(1 << 30); }),
            "BAD_VARIANT_COUNT");
  EXPECT_EQ(reason_after([](Request& r) { r.set_preset("best"); }), "UNKNOWN_PRESET");
  EXPECT_EQ(reason_after([](Request& r) { r.set_output(static_cast<v1::OutputEncoding>(9)); }),
            "UNKNOWN_OUTPUT");
}

TEST(AugmentConvertTest, DeliveredVariantSurvivesTheRoundTrip) {
  api::DeliveredVariant variant{.source_index = 3,
                                .index = 5,
                                .seed = 77,
                                .result = poise::testing::SwingingClip(4),
                                .ik = api::IkOutcome{.end_effector = motion::JointRole::kRightAnkle,
                                                     .keyframe = 2,
                                                     .target = {1, 2, 3},
                                                     .reached_error_m = 0.5,
                                                     .reachable = true},
                                .plausibility = motion::Plausibility{.foot_skate_mps = 1,
                                                                     .penetration_mean_m = 2,
                                                                     .penetration_max_m = 3,
                                                                     .float_mean_m = 4,
                                                                     .self_penetration_max_m = 5,
                                                                     .acceleration_rms_mps2 = 6,
                                                                     .jerk_rms_mps3 = 7}};
  const StatusOr<api::DeliveredVariant> back = FromProto(ToProto(variant));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->source_index, 3);
  EXPECT_EQ(back->index, 5);
  EXPECT_EQ(back->seed, 77u);
  EXPECT_EQ(std::get<motion::Clip>(back->result).num_frames(), 4);
  EXPECT_EQ(back->ik->end_effector, motion::JointRole::kRightAnkle);
  EXPECT_EQ(back->ik->keyframe, 2);
  EXPECT_EQ(back->ik->target, motion::Vec3(1, 2, 3));
  EXPECT_EQ(back->ik->reached_error_m, 0.5);
  EXPECT_TRUE(back->ik->reachable);
  EXPECT_EQ(back->plausibility->foot_skate_mps, 1);
  EXPECT_EQ(back->plausibility->penetration_mean_m, 2);
  EXPECT_EQ(back->plausibility->penetration_max_m, 3);
  EXPECT_EQ(back->plausibility->float_mean_m, 4);
  EXPECT_EQ(back->plausibility->self_penetration_max_m, 5);
  EXPECT_EQ(back->plausibility->acceleration_rms_mps2, 6);
  EXPECT_EQ(back->plausibility->jerk_rms_mps3, 7);

  variant.result = api::EncodedClip{.name = "v.bvh", .data = "x", .skeleton_data = "", .hints = {}};
  EXPECT_EQ(std::get<api::EncodedClip>(FromProto(ToProto(variant))->result).data, "x");
  variant.result = std::string("artifacts/ab");
  EXPECT_EQ(std::get<std::string>(FromProto(ToProto(variant))->result), "artifacts/ab");
  EXPECT_EQ(base::ErrorReason(FromProto(v1::AugmentResponse()).status()), "EMPTY_RESULT");
}

}  // namespace
}  // namespace poise::convert
