#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

#include "absl/time/clock.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::ServerProcess;
using testing::SwingRequest;

// Reads a stream of endless variants for a moment, so that the server is busy with it.
struct BusyStream {
  explicit BusyStream(const ServerProcess& server)
      : channel(server.NewChannel()),
        stub(v1::AugmentationService::NewStub(channel)),
        reader(stub->Augment(&context, SwingRequest(3600, 500'000))),
        pump([this] {
          v1::AugmentResponse response;
          while (reader->Read(&response)) {
          }
        }) {
    absl::SleepFor(absl::Seconds(1));
  }

  std::shared_ptr<grpc::Channel> channel;
  grpc::ClientContext context;
  std::unique_ptr<v1::AugmentationService::Stub> stub;
  std::unique_ptr<grpc::ClientReader<v1::AugmentResponse>> reader;
  std::thread pump;
};

// CPU time since `start` when the server has become idle: a second with less than 5 ms of it, which
// is what gRPC's own timers take.
double CpuUntilIdle(const ServerProcess& server, double start) {
  double last = server.CpuSeconds();
  while (true) {
    absl::SleepFor(absl::Seconds(1));
    const double now = server.CpuSeconds();
    if (now - last < 0.005) return now - start;
    last = now;
  }
}

TEST(AbandonedWorkTest, CancelledClientStopsItsWorkWithinATenthOfASecondOfCpu) {
  ServerProcess server;
  const double idle = server.CpuSeconds();
  BusyStream stream(server);
  const double before = server.CpuSeconds();
  ASSERT_GT(before - idle, 0.1) << "the server was not busy";
  stream.context.TryCancel();
  const double after_cancel = CpuUntilIdle(server, before);
  stream.pump.join();
  stream.reader->Finish();
  std::printf("CPU after cancel: %.0f ms\n", after_cancel * 1e3);
  EXPECT_LT(after_cancel, 0.1);
}

TEST(AbandonedWorkTest, DeadlineStopsTheWorkWithinATenthOfASecondOfCpu) {
  ServerProcess server;
  const auto channel = server.NewChannel();
  const auto stub = v1::AugmentationService::NewStub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(1));
  const auto reader = stub->Augment(&context, SwingRequest(3600, 500'000));
  v1::AugmentResponse response;
  while (reader->Read(&response)) {
  }
  const double after_deadline = CpuUntilIdle(server, server.CpuSeconds());
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  std::printf("CPU after the deadline: %.0f ms\n", after_deadline * 1e3);
  EXPECT_LT(after_deadline, 0.1);
}

// The client side of the next test, in a process of its own.
TEST(AbandonedWorkClient, DISABLED_ReadsForEver) {
  const auto channel = testing::ConnectTo(std::getenv("POISE_TEST_ADDRESS"));
  const auto stub = v1::AugmentationService::NewStub(channel);
  grpc::ClientContext context;
  const auto reader = stub->Augment(&context, SwingRequest(3600, 500'000));
  v1::AugmentResponse response;
  while (reader->Read(&response)) {
  }
}

TEST(AbandonedWorkTest, KilledClientStopsItsWorkWithinATenthOfASecondOfCpu) {
  ServerProcess server;
  setenv("POISE_TEST_ADDRESS", server.address().c_str(), 1);
  const pid_t client = fork();
  if (client == 0) {
    execl("/proc/self/exe", "poised_test", "--gtest_also_run_disabled_tests",
          "--gtest_filter=AbandonedWorkClient.*", nullptr);
    _exit(127);
  }
  const double idle = server.CpuSeconds();
  while (server.CpuSeconds() < idle + 1) absl::SleepFor(absl::Milliseconds(20));
  const double before = server.CpuSeconds();
  kill(client, SIGKILL);
  waitpid(client, nullptr, 0);
  const double after_kill = CpuUntilIdle(server, before);
  std::printf("CPU after the client was killed: %.0f ms\n", after_kill * 1e3);
  EXPECT_LT(after_kill, 0.1);
}

}  // namespace
}  // namespace poise::server
