#include "core/motion/motion_signature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_clips.h"

namespace poise::motion {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

MotionSignature MadeSignature() { return {.roles = RequiredRoles(), .frame_rate = 30}; }

TEST(MotionSignatureTest, SixteenSixDJointsAndARootAre99Columns) {
  EXPECT_EQ(MadeSignature().width(), 99);
  MotionSignature signature{.roles = {JointRole::kPelvis},
                            .rotation = RotationRepresentation::kExponentialMap,
                            .with_root_position = false};
  EXPECT_EQ(signature.width(), 3);
}

TEST(MotionSignatureTest, JsonKeepsEveryField) {
  const MotionSignature signature{.roles = {JointRole::kPelvis, JointRole::kLeftToe},
                                  .rotation = RotationRepresentation::kExponentialMap,
                                  .with_root_position = false,
                                  .frame_rate = 60};
  const auto again = SignatureFromJson(ToJson(signature));
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(*again, signature);
}

TEST(MotionSignatureTest, MalformedJsonIsRefused) {
  base::Json json = ToJson(MadeSignature());
  json["roles"][3] = "tail";
  EXPECT_EQ(base::ErrorReason(SignatureFromJson(json).status()), "UNKNOWN_ROLE");
  for (const char* key : {"roles", "rotation", "root_position", "frame_rate"}) {
    base::Json spoilt = ToJson(MadeSignature());
    spoilt[key] = base::Json::object();
    EXPECT_EQ(base::ErrorReason(SignatureFromJson(spoilt).status()), "MALFORMED_SIGNATURE") << key;
  }
}

TEST(MotionSignatureTest, EveryDifferenceIsNamed) {
  MotionSignature other = MadeSignature();
  EXPECT_TRUE(Differences(MadeSignature(), other).empty());
  other.rotation = RotationRepresentation::kQuaternion;
  other.with_root_position = false;
  other.frame_rate = 120;
  other.roles.pop_back();
  EXPECT_THAT(Differences(MadeSignature(), other),
              ElementsAre(HasSubstr("left_elbow, not pelvis"), "rotations as quaternion, not six_d",
                          "no root position", "rate 120 Hz, not 30 Hz"));
}

TEST(MotionSignatureTest, AClipOfAnotherRateOrBodyIsRefusedWithTheReason) {
  const Clip clip = testing::SwingingClip(10, 60);
  const auto roles = JointRoles::Detect(*clip.skeleton());
  ASSERT_TRUE(roles.ok());
  MotionSignature signature = MadeSignature();
  signature.frame_rate = clip.frame_rate() * 1.0005;
  EXPECT_TRUE(CheckFits(signature, "kick@1", clip, *roles).ok());
  signature.frame_rate = 30;

  const auto lone = Skeleton::Create({{.name = "hips", .end_site = {}}});
  ASSERT_TRUE(lone.ok());
  const auto no_roles = JointRoles::Detect(**lone);
  ASSERT_TRUE(no_roles.ok());
  const Status status = CheckFits(signature, "kick@1", clip, *no_roles);
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(base::ErrorReason(status), "SIGNATURE_MISMATCH");
  EXPECT_THAT(base::Message(status), HasSubstr("no joint plays"));
  EXPECT_THAT(base::Message(status), HasSubstr("left_elbow"));
  EXPECT_THAT(base::Message(status), HasSubstr("it has 60 Hz, the model 30 Hz"));
}

}  // namespace
}  // namespace poise::motion
