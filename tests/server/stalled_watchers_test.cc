#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "absl/time/clock.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/sanitizer.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::FakeWorker;
using testing::JobClient;
using testing::ServerProcess;

constexpr int kWatchers = 1000;
constexpr int kPerConnection = 100;

// A client that watches a job and reads nothing.
struct StalledWatcher {
  StalledWatcher(const JobClient& client, const std::string& name) {
    v1::WatchJobRequest request;
    request.set_name(name);
    reader = client.stub().WatchJob(&context, request);
  }
  ~StalledWatcher() {
    context.TryCancel();
    reader->Finish();
  }

  grpc::ClientContext context;
  std::unique_ptr<grpc::ClientReader<v1::WatchJobResponse>> reader;
};

// An attempt that fails with a long message: two events, more than 1 kB.
void RunAttempt(const FakeWorker& worker) {
  v1::FinishJobRequest finish;
  finish.mutable_error()->set_code(static_cast<int>(absl::StatusCode::kUnavailable));
  finish.mutable_error()->set_message(std::string(1000, 'x'));
  ASSERT_TRUE(worker.Finish(worker.MustLease(absl::Seconds(20)), finish).ok());
}

int Threads(const ServerProcess& server) {
  int threads = 0;
  for ([[maybe_unused]] const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(server.pid()) + "/task")) {
    ++threads;
  }
  return threads;
}

TEST(StalledWatchersTest, ThousandWatchersThatDoNotReadCostAFixedAmountOfMemoryAndNoThread) {
  ServerProcess server({"--first-backoff-seconds", "0.001", "--max-backoff-seconds", "0.001",
                        "--log-level", "error"});
  const JobClient client(server.NewChannel());
  v1::CreateJobRequest request = testing::SelftestRequest();
  request.mutable_limits()->set_max_errors(1000);
  const std::string name = client.Create(request)->name();
  const FakeWorker worker(server.NewChannel());
  RunAttempt(worker);
  const double mib = 1 << 20;
  const double idle = server.ResidentBytes() / mib;
  const int threads = Threads(server);
  std::vector<JobClient> connections;
  std::vector<std::unique_ptr<StalledWatcher>> watchers;
  for (int i = 0; i < kWatchers; ++i) {
    if (i % kPerConnection == 0) connections.emplace_back(server.NewChannel());
    watchers.push_back(std::make_unique<StalledWatcher>(connections.back(), name));
  }
  for (int i = 0; i < 80; ++i) RunAttempt(worker);  // the windows fill
  absl::SleepFor(absl::Seconds(3));
  const double filled = server.ResidentBytes() / mib;
  for (int i = 0; i < 80; ++i) RunAttempt(worker);
  absl::SleepFor(absl::Seconds(1));
  const double later = server.ResidentBytes() / mib;
  const double cpu = server.CpuSeconds();
  absl::SleepFor(absl::Seconds(3));
  const double cpu_later = server.CpuSeconds();
  std::printf(
      "RSS: idle %.0f MiB, %d stalled watchers %.0f MiB, 160 events later %.0f MiB; threads %d, "
      "then %d; CPU in 3 s: %.0f ms\n",
      idle, kWatchers, filled, later, threads, Threads(server), (cpu_later - cpu) * 1e3);
  if (!testing::kInstrumented) {  // AddressSanitizer keeps what was freed
    EXPECT_LT(later, filled + 16);
    EXPECT_LT(filled - idle, 0.2 * kWatchers);
  }
  EXPECT_LE(Threads(server), threads + 4);  // gRPC's own come and go
  EXPECT_LT(cpu_later - cpu, 0.5);
  // One of them reads after all, and nothing is missing.
  ASSERT_TRUE(client.Cancel(name).ok());
  int64_t change = 0;
  v1::WatchJobResponse message;
  while (watchers.front()->reader->Read(&message)) {
    if (!message.has_event()) continue;
    EXPECT_EQ(message.event().change(), ++change);
  }
  EXPECT_EQ(message.event().state(), v1::Job::CANCELLED);
  EXPECT_EQ(change, 1 + 2 * 161 + 1);
}

}  // namespace
}  // namespace poise::server
