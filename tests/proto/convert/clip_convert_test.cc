#include "proto/convert/clip_convert.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/test_clips.h"

namespace poise::convert {
namespace {

using ::testing::HasSubstr;

v1::Clip ValidClip() { return ToProto(poise::testing::SwingingClip(5)); }

void ExpectError(const Status& status, const std::string& reason, const std::string& field) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  EXPECT_EQ(base::ErrorReason(status), reason) << status;
  EXPECT_EQ(base::ErrorField(status), field) << status;
}

TEST(ClipConvertTest, ClipSurvivesTheRoundTripToSinglePrecision) {
  const motion::Clip clip = poise::testing::SwingingClip(50);
  const StatusOr<motion::Clip> back = FromProto(ToProto(clip));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->name(), clip.name());
  EXPECT_EQ(back->frame_rate(), clip.frame_rate());
  EXPECT_TRUE(back->skeleton()->SameAs(*clip.skeleton()));
  ASSERT_EQ(back->num_frames(), 50);
  for (int frame = 0; frame < 50; ++frame) {
    EXPECT_LT((back->root_position(frame) - clip.root_position(frame)).norm(), 1e-6);
    for (int joint = 0; joint < clip.num_joints(); ++joint) {
      const auto error =
          back->rotation(frame, joint).coeffs() - clip.rotation(frame, joint).coeffs();
      EXPECT_LT(error.norm(), 1e-6);
    }
  }
}

TEST(ClipConvertTest, EndSitesSurviveTheRoundTrip) {
  const motion::SkeletonPtr skeleton = poise::testing::Biped();
  const motion::SkeletonPtr back = *FromProto(ToProto(*skeleton));
  for (int joint = 0; joint < skeleton->num_joints(); ++joint) {
    EXPECT_EQ(back->joint(joint).end_site, skeleton->joint(joint).end_site);
  }
}

TEST(ClipConvertTest, EncodedAndStoredFilesSurviveTheRoundTrip) {
  const motion::ClipHints hints{.unit_m = 0.0254, .up = motion::UpAxis::kZ, .frame_rate = 60.0};
  const api::EncodedClip file{"a.amc", std::string("\0\xff", 2), motion::ClipFormat::kAmc, "asf",
                              hints};
  const api::EncodedClip file_back = *FromProto(ToProto(file));
  EXPECT_EQ(file_back.data, file.data);
  EXPECT_EQ(file_back.format, file.format);
  EXPECT_EQ(file_back.skeleton_data, "asf");
  EXPECT_EQ(file_back.hints.unit_m, hints.unit_m);
  EXPECT_EQ(file_back.hints.up, hints.up);
  EXPECT_EQ(file_back.hints.frame_rate, hints.frame_rate);

  const api::StoredClip stored{"artifacts/00", "a.npz", motion::ClipFormat::kNpz, "", {}};
  const api::StoredClip stored_back = *FromProto(ToProto(stored));
  EXPECT_EQ(stored_back.artifact, stored.artifact);
  EXPECT_EQ(stored_back.name, "a.npz");
  EXPECT_FALSE(stored_back.hints.unit_m.has_value());
}

TEST(ClipConvertTest, EveryFormatSurvivesTheRoundTrip) {
  for (int format = 0; format < v1::ClipFormat_ARRAYSIZE; ++format) {
    const auto wire = static_cast<v1::ClipFormat>(format);
    EXPECT_EQ(ToProto(*FromProto(wire)), wire);
  }
}

TEST(ClipConvertTest, SourcesKeepTheirKindAndTheirRoles) {
  const std::vector<api::ClipSource> sources = {
      {poise::testing::SwingingClip(2), {{"pelvis", "Hips"}}},
      {api::EncodedClip{.name = "b.bvh", .data = "HIERARCHY", .skeleton_data = "", .hints = {}},
       {}},
      {api::StoredClip{.artifact = "artifacts/1", .name = "c", .skeleton_data = "", .hints = {}},
       {}}};
  for (const api::ClipSource& source : sources) {
    const StatusOr<api::ClipSource> back = FromProto(ToProto(source));
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(back->clip.index(), source.clip.index());
    EXPECT_EQ(back->joint_roles, source.joint_roles);
  }
}

TEST(ClipConvertTest, WrongCountsNameTheFieldAndBothNumbers) {
  v1::Clip clip = ValidClip();
  clip.mutable_rotations()->RemoveLast();
  const Status status = FromProto(clip).status();
  ExpectError(status, "WRONG_SHAPE", "rotations");
  EXPECT_THAT(base::Message(status), HasSubstr("has 419 numbers, expected 5 frames x 21 joints"));

  clip = ValidClip();
  clip.add_root_positions(0);
  ExpectError(FromProto(clip).status(), "WRONG_SHAPE", "root_positions");

  clip = ValidClip();
  clip.clear_root_positions();
  clip.clear_rotations();
  ExpectError(FromProto(clip).status(), "NO_FRAMES", "root_positions");
}

TEST(ClipConvertTest, BadSkeletonsNameTheJoint) {
  v1::Clip clip = ValidClip();
  clip.mutable_skeleton()->mutable_joints(3)->set_parent(7);
  ExpectError(FromProto(clip).status(), "BAD_PARENT", "skeleton.joints[3]");

  clip = ValidClip();
  clip.mutable_skeleton()->mutable_joints(2)->mutable_offset()->set_y(
      std::numeric_limits<double>::infinity());
  ExpectError(FromProto(clip).status(), "NOT_FINITE", "skeleton.joints[2]");

  clip = ValidClip();
  for (int i = 0; i < 2000; ++i) clip.mutable_skeleton()->add_joints();
  ExpectError(FromProto(clip).status(), "TOO_MANY_JOINTS", "skeleton.joints");

  ExpectError(FromProto(v1::Clip()).status(), "EMPTY_SKELETON", "skeleton.joints");
}

TEST(ClipConvertTest, BadNumbersAreRefused) {
  v1::Clip clip = ValidClip();
  clip.set_rotations(0, std::numeric_limits<float>::quiet_NaN());
  ExpectError(FromProto(clip).status(), "NOT_FINITE", "rotations");

  clip = ValidClip();
  clip.set_rotations(0, 17);
  ExpectError(FromProto(clip).status(), "NOT_A_ROTATION", "rotations");

  clip = ValidClip();
  clip.set_frame_rate(0);
  ExpectError(FromProto(clip).status(), "BAD_FRAME_RATE", "frame_rate");
}

TEST(ClipConvertTest, HintsOutsideTheirRangeAreRefused) {
  v1::ClipSource source;
  source.mutable_file()->mutable_hints()->set_unit_m(-1);
  ExpectError(FromProto(source).status(), "BAD_HINT", "file.hints.unit_m");
  source.mutable_stored()->mutable_hints()->set_frame_rate(1e9);
  ExpectError(FromProto(source).status(), "BAD_HINT", "stored.hints.frame_rate");
  source.mutable_file()->set_format(static_cast<v1::ClipFormat>(99));
  ExpectError(FromProto(source).status(), "UNKNOWN_FORMAT", "file.format");
  ExpectError(FromProto(v1::ClipSource()).status(), "EMPTY_SOURCE", "source");
}

}  // namespace
}  // namespace poise::convert
