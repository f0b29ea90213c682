#include "server/admission/admission.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "proto/convert/status_convert.h"
#include "tests/support/raw_call.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::SwingRequest;
using testing::TestServer;

// A stream that is not read, so that its call stays at work.
struct OpenStream {
  explicit OpenStream(const TestServer& server)
      : stub(v1::AugmentationService::NewStub(server.channel())),
        reader(stub->Augment(&context, SwingRequest(1000, 100'000))) {
    v1::AugmentResponse response;
    reader->Read(&response);
  }
  ~OpenStream() {
    context.TryCancel();
    reader->Finish();
  }

  grpc::ClientContext context;
  std::unique_ptr<v1::AugmentationService::Stub> stub;
  std::unique_ptr<grpc::ClientReader<v1::AugmentResponse>> reader;
};

Status Augment(const TestServer& server) {
  grpc::Status status;
  testing::ReadVariants(server.channel(), SwingRequest(20, 1), &status);
  return convert::FromGrpc(status);
}

Status AugmentWith(const TestServer& server, const std::string& authorization) {
  const auto stub = v1::AugmentationService::NewStub(server.channel());
  grpc::ClientContext context;
  if (!authorization.empty()) context.AddMetadata("authorization", authorization);
  const auto reader = stub->Augment(&context, SwingRequest(20, 1));
  v1::AugmentResponse response;
  while (reader->Read(&response)) {
  }
  return convert::FromGrpc(reader->Finish());
}

void ExpectRefusal(const Status& status, const std::string& reason) {
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(base::ErrorReason(status), reason);
  EXPECT_EQ(base::RetryDelay(status), absl::Seconds(1));
}

TEST(AdmissionTest, CallsAboveTheLimitAreRefusedWithARetryTime) {
  ServerConfig config;
  config.admission.max_calls = 2;
  TestServer server(config);
  {
    const OpenStream first(server), second(server);
    ExpectRefusal(Augment(server), "TOO_MANY_CALLS");
  }
  while (server.server().calls() > 0) absl::SleepFor(absl::Milliseconds(5));
  EXPECT_TRUE(Augment(server).ok());
}

TEST(AdmissionTest, OneClientCannotTakeAllPlaces) {
  ServerConfig config;
  config.admission.max_calls_per_peer = 1;
  TestServer server(config);
  const OpenStream first(server);
  ExpectRefusal(Augment(server), "TOO_MANY_CALLS_OF_PEER");
}

TEST(AdmissionTest, CallsMustCarryTheTokenWhereThereIsOne) {
  ServerConfig config;
  config.admission.token = "open sesame";
  TestServer server(config);
  EXPECT_EQ(base::ErrorReason(AugmentWith(server, "")), "MISSING_TOKEN");
  EXPECT_EQ(base::ErrorReason(AugmentWith(server, "Bearer open sesamf")), "WRONG_TOKEN");
  EXPECT_EQ(base::ErrorReason(AugmentWith(server, "open sesame")), "WRONG_TOKEN");
  EXPECT_EQ(AugmentWith(server, "Bearer x").code(), absl::StatusCode::kUnauthenticated);
  EXPECT_TRUE(AugmentWith(server, "Bearer open sesame").ok());
  EXPECT_EQ(testing::HealthOf(server.channel(), ""), "SERVING");
}

TEST(AdmissionTest, SecondServerOnAPortSaysThatThePortIsTaken) {
  TestServer first;
  ServerConfig config;
  config.listen = first.server().address();
  testing::TemporaryFolder folder;
  PrometheusTelemetry telemetry;
  const auto engine = *engine::Engine::Create({.data_dir = folder.path()}, telemetry);
  const Status status = Server::Start(config, *engine, telemetry).status();
  EXPECT_EQ(base::ErrorReason(status), "CANNOT_LISTEN");
  EXPECT_NE(base::Message(status).find(config.listen), std::string::npos) << status;
}

}  // namespace
}  // namespace poise::server
