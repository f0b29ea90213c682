#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <random>
#include <thread>

#include "absl/time/clock.h"
#include "tests/support/fake_worker.h"
#include "tests/support/job_client.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using ::testing::ElementsAre;
using testing::FakeWorker;
using testing::JobClient;
using testing::SelftestRequest;
using testing::TestServer;

// What one watch gave.
struct Watched {
  std::vector<v1::Job> snapshots;
  std::vector<v1::JobEvent> events;
  Status status;

  int64_t last_seq() const { return events.empty() ? 0 : events.back().seq(); }
  std::vector<int> states() const {
    std::vector<int> states;
    for (const v1::JobEvent& event : events) {
      if (event.has_state()) states.push_back(event.state());
    }
    return states;
  }
};

Watched Watch(const JobClient& client, const std::string& name, int64_t after_seq = 0) {
  Watched watched;
  watched.status = client.Watch(name, after_seq, [&](const v1::WatchJobResponse& message) {
    if (message.has_snapshot()) watched.snapshots.push_back(message.snapshot());
    if (message.has_event()) watched.events.push_back(message.event());
  });
  return watched;
}

// A watch of which only the first messages are read.
Watched WatchFirst(const JobClient& client, const std::string& name, int64_t after_seq,
                   int messages) {
  v1::WatchJobRequest request;
  request.set_name(name);
  request.set_after_seq(after_seq);
  const auto context = client.NewContext();
  const auto reader = client.stub().WatchJob(context.get(), request);
  Watched watched;
  v1::WatchJobResponse message;
  for (int i = 0; i < messages && reader->Read(&message); ++i) {
    if (message.has_snapshot()) watched.snapshots.push_back(message.snapshot());
    if (message.has_event()) watched.events.push_back(message.event());
  }
  context->TryCancel();
  reader->Finish();
  return watched;
}

void AwaitCalls(TestServer& server, int calls) {
  while (server.server().calls() < calls) absl::SleepFor(absl::Milliseconds(1));
}

// A call whose client has its answer still counts until the server has ended it.
void AwaitNoCalls(TestServer& server) {
  while (server.server().calls() > 0) absl::SleepFor(absl::Milliseconds(1));
}

TEST(JobWatchTest, ComesWithTheJobThenItsEventsAndTheTerminalOneLast) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  auto watch = std::async(std::launch::async, [&] { return Watch(client, name); });
  AwaitCalls(server, 1);
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  ASSERT_TRUE(worker.Heartbeat(lease, 5).ok());
  const std::string artifact = server.engine().artifacts().Put("state")->name;
  ASSERT_TRUE(worker.Checkpoint(lease, artifact, 5).ok());
  ASSERT_TRUE(worker.Finish(lease).ok());
  const Watched watched = watch.get();
  EXPECT_TRUE(watched.status.ok()) << watched.status;
  ASSERT_GE(watched.snapshots.size(), 1u);
  EXPECT_EQ(watched.snapshots[0].name(), name);
  EXPECT_THAT(watched.states(), ElementsAre(v1::Job::QUEUED, v1::Job::RUNNING, v1::Job::SUCCEEDED));
  int64_t seq = 0, change = 0;
  bool progress = false, checkpoint = false;
  for (const v1::JobEvent& event : watched.events) {
    EXPECT_GT(event.seq(), seq);
    seq = event.seq();
    if (!event.has_progress()) ++change;
    EXPECT_EQ(event.change(), change);
    if (event.has_progress()) progress = event.progress().step() == 5;
    if (event.has_checkpoint()) checkpoint = event.checkpoint().step() == 5;
  }
  EXPECT_TRUE(progress);
  EXPECT_TRUE(checkpoint);
  EXPECT_EQ(watched.events.back().state(), v1::Job::SUCCEEDED);
}

TEST(JobWatchTest, NewsArriveWhileTheWorkerWorks) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  v1::WatchJobRequest request;
  request.set_name(name);
  const auto context = client.NewContext();
  const auto reader = client.stub().WatchJob(context.get(), request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_snapshot());
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::QUEUED);
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  const absl::Time begin = absl::Now();
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::RUNNING);
  ASSERT_TRUE(client.Cancel(name).ok());
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::CANCELLING);
  ASSERT_TRUE(worker.Fail(lease, absl::StatusCode::kCancelled).ok());
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::CANCELLED);
  EXPECT_EQ(message.event().error().code(), static_cast<int>(absl::StatusCode::kCancelled));
  EXPECT_FALSE(reader->Read(&message));
  EXPECT_TRUE(reader->Finish().ok());
  // Nothing else wakes a watch but the news.
  EXPECT_LT(absl::Now() - begin, absl::Seconds(10));
}

TEST(JobWatchTest, WhoJoinsLateGetsEverythingAndWhoJoinsAgainTheRest) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const FakeWorker worker(server.channel());
  const v1::Lease lease = worker.MustLease();
  ASSERT_TRUE(worker.Finish(lease).ok());
  const Watched all = Watch(client, name);
  EXPECT_TRUE(all.status.ok()) << all.status;
  EXPECT_THAT(all.states(), ElementsAre(v1::Job::QUEUED, v1::Job::RUNNING, v1::Job::SUCCEEDED));
  const Watched rest = Watch(client, name, all.events[1].seq());
  EXPECT_THAT(rest.states(), ElementsAre(v1::Job::SUCCEEDED));
  EXPECT_EQ(rest.snapshots.size(), 1u);
  // The terminal event was seen: it does not come twice.
  const Watched nothing = Watch(client, name, all.last_seq());
  EXPECT_TRUE(nothing.status.ok()) << nothing.status;
  EXPECT_EQ(nothing.snapshots.size(), 1u);
  EXPECT_TRUE(nothing.events.empty());
  // A number that the store has not reached: it was restored from a backup.
  EXPECT_TRUE(Watch(client, name, all.last_seq() + 1000).status.ok());
}

TEST(JobWatchTest, WatchersThatBreakOffAndJoinAgainMissNothingAndSeeNothingTwice) {
  TestServer server;
  const JobClient client(server.channel());
  v1::CreateJobRequest request = SelftestRequest();
  request.mutable_limits()->set_max_losses(1000);
  const std::string name = client.Create(request)->name();
  std::vector<std::future<std::vector<v1::JobEvent>>> watchers;
  for (unsigned seed = 0; seed < 4; ++seed) {
    watchers.push_back(std::async(std::launch::async, [&, seed] {
      std::mt19937 random(seed);
      std::vector<v1::JobEvent> events;
      while (events.empty() || events.back().state() != v1::Job::SUCCEEDED) {
        const Watched some = WatchFirst(client, name, events.empty() ? 0 : events.back().seq(),
                                        1 + static_cast<int>(random() % 5));
        events.insert(events.end(), some.events.begin(), some.events.end());
      }
      return events;
    }));
  }
  const FakeWorker worker(server.channel());
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(worker.Release(worker.MustLease()).ok());
  ASSERT_TRUE(worker.Finish(worker.MustLease()).ok());
  for (auto& watcher : watchers) {
    int64_t change = 0;
    for (const v1::JobEvent& event : watcher.get()) EXPECT_EQ(event.change(), ++change);
    EXPECT_EQ(change, 1 + 2 * 60 + 2);
  }
}

TEST(JobWatchTest, SilentJobIsShownAgainNowAndThen) {
  ServerConfig config;
  config.snapshot_interval = absl::Milliseconds(100);
  TestServer server(config);
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const Watched watched = WatchFirst(client, name, 0, 5);
  EXPECT_EQ(watched.snapshots.size(), 4u);
  EXPECT_EQ(watched.events.size(), 1u);
}

TEST(JobWatchTest, WatchThatLastsTooLongAsksToJoinAgain) {
  ServerConfig config;
  config.methods.watch.max_deadline = config.methods.watch.default_deadline =
      absl::Milliseconds(300);
  TestServer server(config);
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  const Watched watched = Watch(client, name);
  EXPECT_EQ(watched.status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(base::ErrorReason(watched.status), "WATCH_EXPIRED");
  EXPECT_TRUE(base::RetryDelay(watched.status).has_value());
  EXPECT_THAT(watched.states(), ElementsAre(v1::Job::QUEUED));
  ASSERT_TRUE(client.Cancel(name).ok());
  EXPECT_THAT(Watch(client, name, watched.last_seq()).states(), ElementsAre(v1::Job::CANCELLED));
}

TEST(JobWatchTest, ServerThatStopsSendsItsWatchersAway) {
  TestServer server;
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  constexpr int kWatchers = 50;
  std::vector<std::future<Watched>> watchers;
  for (int i = 0; i < kWatchers; ++i) {
    watchers.push_back(std::async(std::launch::async, [&] { return Watch(client, name); }));
  }
  AwaitCalls(server, kWatchers);
  server.server().AnnounceShutdown();
  absl::SleepFor(absl::Milliseconds(100));
  EXPECT_EQ(server.server().calls(), kWatchers);  // lame duck
  const absl::Time begin = absl::Now();
  server.server().Shutdown(absl::Now() + absl::Seconds(60));
  EXPECT_LT(absl::Now() - begin, absl::Seconds(30));
  for (auto& watcher : watchers) {
    const Watched watched = watcher.get();
    EXPECT_EQ(base::ErrorReason(watched.status), "SHUTTING_DOWN") << watched.status;
    EXPECT_TRUE(base::RetryDelay(watched.status).has_value());
  }
}

TEST(JobWatchTest, WatchersTakeNoPlacesFromOthersAndLeaveSomeToWorkers) {
  ServerConfig config;
  config.admission.max_calls = 2;
  config.admission.max_waiting_calls = 20;
  TestServer server(config);
  const JobClient client(server.channel());
  const std::string name = client.Create(SelftestRequest())->name();
  AwaitNoCalls(server);  // else it is taken for a watcher
  std::vector<std::future<Watched>> watchers;
  for (int i = 0; i < 18; ++i) {
    watchers.push_back(std::async(std::launch::async, [&] { return Watch(client, name); }));
  }
  AwaitCalls(server, 18);
  const Status refused = Watch(client, name).status;
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(base::ErrorReason(refused), "TOO_MANY_WAITING_CALLS");
  EXPECT_TRUE(base::RetryDelay(refused).has_value());
  grpc::Status status;
  EXPECT_EQ(testing::ReadVariants(server.channel(), testing::SwingRequest(20, 2), &status).size(),
            2u);
  const FakeWorker worker(server.channel());
  ASSERT_TRUE(worker.Finish(worker.MustLease()).ok());
  for (auto& watcher : watchers) EXPECT_TRUE(watcher.get().status.ok());
}

}  // namespace
}  // namespace poise::server
