#include "client/channel.h"

#include <gtest/gtest.h>

#include <thread>

#include "absl/time/clock.h"
#include "client/backoff.h"
#include "client/client.h"
#include "tests/client/fake_jobs.h"

#ifdef __SANITIZE_ADDRESS__
// The resolver of Debian's gRPC loses a few bytes when a look-up is given up.
extern "C" const char* __lsan_default_suppressions() { return "leak:libcares"; }
#endif

namespace poise::client {
namespace {

class ChannelTest : public ::testing::Test {
 protected:
  ChannelTest()
      : server_(std::make_unique<testing::FakeServer>(jobs_, artifacts_)),
        id_(jobs_.Add(api::JobState::kRunning)) {}

  std::unique_ptr<Client> Connect(const std::string& server) {
    ClientOptions options;
    options.server = server;
    return *Client::Connect(options);
  }

  testing::FakeJobs jobs_;
  testing::FakeArtifacts artifacts_;
  std::unique_ptr<testing::FakeServer> server_;
  std::string id_;
};

TEST_F(ChannelTest, AServerThatIsGoneForSecondsIsWaitedFor) {
  const std::string port = server_->address.substr(server_->address.find(':'));
  for (const std::string host : {"127.0.0.1", "localhost"}) {
    const auto client = Connect(host + port);
    ASSERT_TRUE(client->GetJob(id_).ok());
    server_.reset();
    std::thread restart([&] {
      absl::SleepFor(absl::Seconds(2));
      server_ = std::make_unique<testing::FakeServer>(jobs_, artifacts_, "127.0.0.1" + port);
    });
    const absl::Time begin = absl::Now();
    const auto job = client->GetJob(id_);
    const absl::Duration took = absl::Now() - begin;
    restart.join();
    EXPECT_TRUE(job.ok()) << host << ": " << job.status();
    EXPECT_GT(took, absl::Seconds(1)) << host;
  }
}

TEST_F(ChannelTest, OfSeveralServersOneIsEnough) {
  auto second = std::make_unique<testing::FakeServer>(jobs_, artifacts_);
  const auto client = Connect(server_->address + "," + second->address);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(client->GetJob(id_).ok());
  server_.reset();
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(client->GetJob(id_).ok()) << i;
}

TEST_F(ChannelTest, OfServersThatAreAllGoneTheClientIsToldAtOnce) {
  ClientOptions options;
  options.server = "127.0.0.1:1,127.0.0.1:2";
  const absl::Time begin = absl::Now();
  const auto client = Client::Connect(options);
  EXPECT_EQ(base::ErrorReason(client.status()), "NO_SERVER") << client.status();
  EXPECT_LT(absl::Now() - begin, options.connect_timeout);
}

TEST(ChannelTargetTest, OnlyListsBecomeUris) {
  EXPECT_EQ(ChannelTarget("gpu7:50051"), "gpu7:50051");
  EXPECT_EQ(ChannelTarget("10.0.0.1:1,10.0.0.2:1"), "ipv4:10.0.0.1:1,10.0.0.2:1");
  EXPECT_EQ(ChannelTarget("ipv4:10.0.0.1:1,10.0.0.2:1"), "ipv4:10.0.0.1:1,10.0.0.2:1");
  EXPECT_EQ(ChannelTarget("[::1]:1,[::2]:1"), "ipv6:[::1]:1,[::2]:1");
}

TEST(BackoffTest, WaitsGrowAreSpreadAndEndWithTheOutage) {
  const Status gone = absl::UnavailableError("gone");
  Backoff backoff(
      {.first = absl::Milliseconds(100), .longest = absl::Seconds(1), .outage = absl::Hours(1)});
  for (const int ceiling : {100, 200, 400, 800, 1000, 1000}) {
    const absl::Duration delay = *backoff.Next(gone);
    EXPECT_GE(delay, absl::Milliseconds(ceiling / 2));
    EXPECT_LE(delay, absl::Milliseconds(ceiling));
  }
  backoff.NoteProgress();
  EXPECT_LE(*backoff.Next(gone), absl::Milliseconds(100));
  Backoff impatient({.first = absl::Seconds(10), .outage = absl::Seconds(1)});
  EXPECT_FALSE(impatient.Next(gone).has_value());
}

TEST(BackoffTest, OnlyWhatMayPassIsTriedAgainAndNotBeforeTheServerSays) {
  Backoff backoff({});
  EXPECT_FALSE(backoff.Next(absl::NotFoundError("")).has_value());
  EXPECT_FALSE(backoff.Next(absl::ResourceExhaustedError("too large")).has_value());
  const Status busy = base::WithRetryDelay(absl::ResourceExhaustedError(""), absl::Seconds(5));
  EXPECT_EQ(*backoff.Next(busy), absl::Seconds(5));
}

}  // namespace
}  // namespace poise::client
