#include "server/telemetry/prometheus_telemetry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using ::testing::HasSubstr;

TEST(PrometheusTelemetryTest, SameNameAndLabelsGiveTheSameInstrument) {
  PrometheusTelemetry telemetry;
  telemetry.counter("c_total", "help", {{"a", "1"}}).Increment();
  telemetry.counter("c_total", "help", {{"a", "1"}}).Increment(2);
  telemetry.counter("c_total", "help", {{"a", "2"}}).Increment();
  telemetry.gauge("g", "help", {}).Set(4);
  telemetry.histogram("h_seconds", "help", {}).Observe(0.004);
  EXPECT_THAT(telemetry.Text(), HasSubstr("c_total{a=\"1\"} 3"));
  EXPECT_THAT(telemetry.Text(), HasSubstr("c_total{a=\"2\"} 1"));
  EXPECT_THAT(telemetry.Text(), HasSubstr("\ng 4"));
  EXPECT_THAT(telemetry.Text(), HasSubstr("h_seconds_bucket{le=\"0.005\"} 1"));
  EXPECT_THAT(telemetry.Text(), HasSubstr("h_seconds_bucket{le=\"0.002\"} 0"));
}

TEST(PrometheusTelemetryTest, AddressThatCannotBeListenedOnIsAClearError) {
  PrometheusTelemetry telemetry;
  const Status status = telemetry.Expose("203.0.113.1:1");
  EXPECT_EQ(base::ErrorReason(status), "CANNOT_LISTEN");
}

TEST(PrometheusTelemetryTest, CallsAreCountedByMethodAndCode) {
  poise::testing::TestServer server;
  grpc::Status status;
  poise::testing::ReadVariants(server.channel(), poise::testing::SwingRequest(20, 3), &status);
  poise::testing::ReadVariants(server.channel(), v1::AugmentRequest(), &status);
  server.server().Shutdown(absl::Now() + absl::Seconds(5));
  const std::string text = server.telemetry().Text();
  const std::string method = "method=\"/poise.v1.AugmentationService/Augment\"";
  EXPECT_THAT(text, HasSubstr("poise_requests_total{code=\"OK\"," + method + "} 1"));
  EXPECT_THAT(text, HasSubstr("poise_requests_total{code=\"INVALID_ARGUMENT\"," + method + "} 1"));
  EXPECT_THAT(text, HasSubstr("poise_augment_variants_total 3"));
  EXPECT_THAT(text, HasSubstr("poise_calls_at_work 0"));
}

}  // namespace
}  // namespace poise::server
