#include "proto/convert/status_convert.h"

#include <gtest/gtest.h>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace poise::convert {
namespace {

TEST(StatusConvertTest, ErrorCarriesReasonDomainAndField) {
  const grpc::Status status =
      ToGrpc(base::InvalidArgument("WRONG_SHAPE", "sources[0].clip.rotations", "30, expected 31"));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(status.error_message(), "30, expected 31");
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), 3);
  ASSERT_EQ(details.details_size(), 2);
  google::rpc::ErrorInfo info;
  ASSERT_TRUE(details.details(0).UnpackTo(&info));
  EXPECT_EQ(info.reason(), "WRONG_SHAPE");
  EXPECT_EQ(info.domain(), "poise.dev");
  EXPECT_EQ(info.metadata().at("field"), "sources[0].clip.rotations");
  google::rpc::BadRequest request;
  ASSERT_TRUE(details.details(1).UnpackTo(&request));
  EXPECT_EQ(request.field_violations(0).field(), "sources[0].clip.rotations");
}

TEST(StatusConvertTest, EveryCodeSurvivesTheRoundTrip) {
  for (int code = 1; code <= 16; ++code) {
    const Status status =
        base::MakeError(static_cast<absl::StatusCode>(code), "SOME_REASON", "a.b", "text");
    const Status back = FromGrpc(ToGrpc(status));
    EXPECT_EQ(back.code(), status.code());
    EXPECT_EQ(base::ErrorReason(back), "SOME_REASON");
    EXPECT_EQ(base::ErrorField(back), "a.b");
    EXPECT_EQ(base::Message(back), "text");
    EXPECT_FALSE(base::RetryDelay(back).has_value());
  }
  EXPECT_TRUE(FromGrpc(ToGrpc(absl::OkStatus())).ok());
}

TEST(StatusConvertTest, RetryTimeTravelsAsRetryInfo) {
  const Status status = base::WithRetryDelay(
      base::ResourceExhausted("TOO_MANY_STREAMS", "", "wait"), absl::Milliseconds(1500));
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(ToGrpc(status).error_details()));
  google::rpc::RetryInfo retry;
  ASSERT_TRUE(details.details(1).UnpackTo(&retry));
  EXPECT_EQ(retry.retry_delay().seconds(), 1);
  EXPECT_EQ(retry.retry_delay().nanos(), 500'000'000);
  EXPECT_EQ(base::RetryDelay(FromGrpc(ToGrpc(status))), absl::Milliseconds(1500));
}

TEST(StatusConvertTest, ForeignStatusesStillGetAnErrorInfo) {
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(ToGrpc(absl::DataLossError("x")).error_details()));
  google::rpc::ErrorInfo info;
  ASSERT_TRUE(details.details(0).UnpackTo(&info));
  EXPECT_EQ(info.reason(), "DATA_LOSS");
  const Status plain = FromGrpc(grpc::Status(grpc::StatusCode::UNAVAILABLE, "refused"));
  EXPECT_EQ(base::ErrorReason(plain), "UNAVAILABLE");
}

TEST(StatusConvertTest, LongAndIllEncodedMessagesStayWithinTheLimitOfTrailingMetadata) {
  const std::string noise(100'000, '\xff');
  const grpc::Status status = ToGrpc(base::InvalidArgument("R", noise, noise));
  // Percent-encoded message plus base64 details, against gRPC's 8 KiB.
  EXPECT_LT(3 * status.error_message().size() + 4 * status.error_details().size() / 3, 8000u);
}

}  // namespace
}  // namespace poise::convert
