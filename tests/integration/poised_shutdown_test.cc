#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "tests/support/raw_call.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::ServerProcess;
using testing::SwingRequest;

TEST(PoisedShutdownTest, TerminationAnnouncesItselfServesOnAndEndsWithZero) {
  ServerProcess server({"--lame-duck-seconds", "1", "--drain-seconds", "20"});
  const auto channel = server.NewChannel();
  ASSERT_EQ(testing::HealthOf(channel, ""), "SERVING");
  const auto stub = v1::AugmentationService::NewStub(channel);
  grpc::ClientContext context;
  const auto running = stub->Augment(&context, SwingRequest(120, 500));
  v1::AugmentResponse response;
  ASSERT_TRUE(running->Read(&response));
  server.Signal(SIGTERM);
  absl::SleepFor(absl::Milliseconds(200));
  EXPECT_EQ(testing::HealthOf(channel, ""), "NOT_SERVING");
  grpc::Status during_lame_duck;
  EXPECT_EQ(
      testing::ReadVariants(server.NewChannel(), SwingRequest(20, 2), &during_lame_duck).size(),
      2u);
  int variants = 1;
  while (running->Read(&response)) ++variants;
  EXPECT_TRUE(running->Finish().ok());
  EXPECT_EQ(variants, 500);
  EXPECT_EQ(server.Wait(), 0);
}

TEST(PoisedShutdownTest, HundredOpenStreamsEndWithinTheBudget) {
  ServerProcess server({"--lame-duck-seconds", "0.2", "--drain-seconds", "1"});
  const auto channel = server.NewChannel();
  const auto stub = v1::AugmentationService::NewStub(channel);
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::ClientReader<v1::AugmentResponse>>> readers;
  const v1::AugmentRequest request = SwingRequest(360, 100'000);
  for (int i = 0; i < 100; ++i) {
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    readers.push_back(stub->Augment(contexts.back().get(), request));
  }
  v1::AugmentResponse response;
  ASSERT_TRUE(readers.back()->Read(&response));
  const absl::Time start = absl::Now();
  server.Signal(SIGTERM);
  EXPECT_EQ(server.Wait(), 0);
  const double seconds = absl::ToDoubleSeconds(absl::Now() - start);
  std::printf("SIGTERM with 100 open streams, budget 1.2 s: exit code 0 after %.2f s\n", seconds);
  EXPECT_LT(seconds, 1.2 + 10);  // the watchdog's margin
}

}  // namespace
}  // namespace poise::server
