#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "absl/time/clock.h"
#include "tests/support/raw_call.h"
#include "tests/support/sanitizer.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::ServerProcess;
using testing::SwingRequest;

constexpr int kClients = 100;

// A client on its own connection that asks for a million variants and reads one.
struct StalledClient {
  explicit StalledClient(const ServerProcess& server)
      : channel(server.NewChannel()), stub(v1::AugmentationService::NewStub(channel)) {
    reader = stub->Augment(&context, SwingRequest(360, 1'000'000));
    v1::AugmentResponse response;
    reader->Read(&response);
  }
  ~StalledClient() {
    context.TryCancel();
    reader->Finish();
  }

  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::AugmentationService::Stub> stub;
  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<v1::AugmentResponse>> reader;
};

TEST(StalledReadersTest, HundredClientsThatStopReadingCostAFixedAmountOfMemoryAndNoCpu) {
  ServerProcess server;
  const double mib = 1 << 20;
  const double idle = server.ResidentBytes() / mib;
  std::vector<std::unique_ptr<StalledClient>> clients;
  for (int i = 0; i < kClients; ++i) clients.push_back(std::make_unique<StalledClient>(server));
  absl::SleepFor(absl::Seconds(3));  // the windows fill
  const double filled = server.ResidentBytes() / mib;
  const double cpu = server.CpuSeconds();
  absl::SleepFor(absl::Seconds(5));
  const double later = server.ResidentBytes() / mib;
  const double cpu_later = server.CpuSeconds();
  std::printf(
      "RSS: idle %.0f MiB, 100 stalled clients %.0f MiB, 5 s later %.0f MiB; CPU in those "
      "5 s: %.0f ms\n",
      idle, filled, later, (cpu_later - cpu) * 1e3);
  EXPECT_LT(later, filled + 4);
  if (!testing::kInstrumented) {
    EXPECT_LT(filled - idle, 2.5 * kClients);
  }
  EXPECT_LT(cpu_later - cpu, 0.5);
  EXPECT_EQ(testing::HealthOf(server.NewChannel(), ""), "SERVING");
  grpc::Status status;
  EXPECT_EQ(testing::ReadVariants(server.NewChannel(), SwingRequest(60, 10), &status).size(), 10u);
}

}  // namespace
}  // namespace poise::server
