#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/time/clock.h"
#include "client/client.h"
#include "tests/support/job_calls.h"
#include "tests/support/job_cluster.h"
#include "tests/support/sanitizer.h"
#include "tests/support/test_clips.h"

// Servers follow one another under load, and clients that retry as gRPC clients do notice nothing.
namespace poise::testing {
namespace {

// Calls that went well, and what the others said.
struct Load {
  std::atomic<int> done = 0;
  std::mutex mutex;
  std::vector<std::string> failures = {};

  void Count(const char* call, const Status& status) {
    ++done;
    if (status.ok()) return;
    std::lock_guard lock(mutex);
    failures.push_back(
        fmt::format("{}: {} {}", call, base::ErrorReason(status), base::Message(status)));
  }
};

Status AugmentOnce(client::Client& client) {
  api::AugmentSpec spec;
  spec.sources.push_back({.clip = SwingingClip(60), .joint_roles = {}});
  spec.method = "noise";
  spec.variants_per_source = 2;
  POISE_ASSIGN_OR_RETURN(const auto stream, client.Augment(std::move(spec)));
  for (;;) {
    POISE_ASSIGN_OR_RETURN(const auto variant, stream->Next());
    if (!variant) return absl::OkStatus();
  }
}

// One client that calls until `stop`.
void CallUntil(const std::atomic<bool>& stop, const std::string& server, Load& load) {
  client::ClientOptions options;
  options.server = server;
  const auto client = client::Client::Connect(options);
  if (!client.ok()) return load.Count("connect", client.status());
  while (!stop) {
    const auto job = (*client)->CreateJob(Selftest({{"steps", 1}, {"step_ms", 1}}));
    load.Count("create", job.status());
    if (job.ok()) load.Count("get", (*client)->GetJob(job->id).status());
    load.Count("list", (*client)->ListJobs({}, /*page_size=*/5).status());
    load.Count("augment", AugmentOnce(**client));
    absl::SleepFor(absl::Milliseconds(20));
  }
}

TEST(RollingRestartTest, NoCallFailsWhileServersFollowOneAnotherOnTheSameStore) {
  // An instrumented server takes longer to start than a client waits for one.
  POISE_SKIP_WHERE_INSTRUMENTED();
  const int restarts = FromEnvironment("POISE_RESTARTS", 4);
  JobCluster cluster({"--lame-duck-seconds", "0.5", "--drain-seconds", "5", "--workers", "1"});
  std::atomic<bool> stop = false;
  Load load;
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&] { CallUntil(stop, cluster.address(), load); });
  }
  for (int i = 0; i < restarts; ++i) {
    absl::SleepFor(absl::Seconds(1.5));
    EXPECT_EQ(cluster.StopServer(SIGTERM), 0);
    ASSERT_TRUE(cluster.StartServer());
  }
  absl::SleepFor(absl::Seconds(1));
  stop = true;
  for (std::thread& client : clients) client.join();
  std::printf("%d restarts: %d calls, %zu failed\n", restarts, load.done.load(),
              load.failures.size());
  EXPECT_GT(load.done, 50 * restarts);
  for (const std::string& failure : load.failures) ADD_FAILURE() << failure;
}

}  // namespace
}  // namespace poise::testing
