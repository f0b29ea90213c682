#include "core/base/status.h"

#include <gtest/gtest.h>

namespace poise::base {
namespace {

TEST(StatusTest, CarriesReasonAndFieldBesideTheMessage) {
  const Status status = InvalidArgument("WRONG_SHAPE", "clip.rotations", "expected 12, got 11");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ErrorReason(status), "WRONG_SHAPE");
  EXPECT_EQ(ErrorField(status), "clip.rotations");
  EXPECT_EQ(Message(status), "expected 12, got 11");
}

TEST(StatusTest, AForeignStatusGetsItsCodeAsReason) {
  EXPECT_EQ(ErrorReason(absl::NotFoundError("gone")), "NOT_FOUND");
  EXPECT_EQ(ErrorField(absl::NotFoundError("gone")), "");
}

TEST(StatusTest, AnnotateAddsContextAndMovesTheFieldBelowThePrefix) {
  const Status inner = InvalidArgument("WRONG_SHAPE", "rotations", "expected 12, got 11");
  const Status outer = Annotate(inner, "kick.bvh", "sources[2].clip");
  EXPECT_EQ(Message(outer), "kick.bvh: expected 12, got 11");
  EXPECT_EQ(ErrorField(outer), "sources[2].clip.rotations");
  EXPECT_EQ(ErrorReason(outer), "WRONG_SHAPE");
  EXPECT_EQ(ErrorField(Annotate(NotFound("GONE", "", "gone"), "x", "sources[0]")), "sources[0]");
  EXPECT_TRUE(Annotate(absl::OkStatus(), "kick.bvh").ok());
}

StatusOr<int> Half(int value) {
  if (value % 2 != 0) return InvalidArgument("ODD", "value", "odd");
  return value / 2;
}

StatusOr<int> Quarter(int value) {
  POISE_ASSIGN_OR_RETURN(const int half, Half(value));
  POISE_RETURN_IF_ERROR(Half(half).status());
  return Half(half);
}

TEST(StatusTest, TheMacrosReturnTheFirstError) {
  EXPECT_EQ(*Quarter(8), 2);
  EXPECT_EQ(ErrorReason(Quarter(6).status()), "ODD");
  EXPECT_EQ(ErrorReason(Quarter(5).status()), "ODD");
}

}  // namespace
}  // namespace poise::base
