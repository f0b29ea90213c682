// The client against a real poised that is killed under it.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "absl/time/clock.h"
#include "client/client.h"
#include "core/base/json.h"
#include "core/base/sha256.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::client {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMiB = 1 << 20;
constexpr int64_t kFileBytes = 96 * kMiB;

/// A poised that can be killed and started again, on the same port and data folder.
class RestartablePoised {
 public:
  /// `fail_points` as in core/base/fail_point.h.
  void Start(const std::string& fail_points = "") {
    process_.reset();
    process_.emplace(
        std::vector<std::string>{POISE_BIN_DIR "/poised", "--listen", address_, "--data-dir",
                                 data_dir().string(), "--lame-duck-seconds", "0"},
        std::map<std::string, std::string>{{"POISE_FAIL_POINTS", fail_points}});
    ASSERT_TRUE(process_->WaitForOutput("\n", absl::Seconds(60))) << process_->ErrorOutput();
    const std::string ready = process_->Output();
    address_ = base::Json::parse(ready.substr(0, ready.find('\n'))).at("address");
  }
  void Kill() {
    process_->Signal(SIGKILL);
    process_->Wait();
  }
  /// Waits until a fail point has killed it; then starts it without.
  void RestartWhenKilled(const std::string& fail_points = "") {
    ASSERT_EQ(process_->Wait(), -SIGKILL);
    Start(fail_points);
  }

  const std::string& address() const { return address_; }
  fs::path data_dir() const { return folder_.path() / "data"; }

 private:
  poise::testing::TemporaryFolder folder_;
  std::string address_ = "127.0.0.1:0";
  std::optional<poise::testing::Process> process_;
};

class ServerRestartTest : public ::testing::Test {
 protected:
  ServerRestartTest() {
    content_.resize(kFileBytes);
    uint64_t number = 1;
    for (size_t i = 0; i + 8 <= content_.size(); i += 8) {
      number = number * 6364136223846793005u + 1442695040888963407u;
      std::memcpy(&content_[i], &number, 8);
    }
    name_ = "artifacts/" + base::Sha256Hex(content_);
  }

  std::unique_ptr<Client> Connect() const {
    ClientOptions options;
    options.server = poised_.address();
    return *Client::Connect(options);
  }
  bool IsStored(Client& client) const {
    const auto bytes = client.Download(name_);
    return bytes.ok() && *bytes == content_;
  }
  int64_t UnfinishedBytes() const {
    int64_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(poised_.data_dir() / "artifacts/uploads")) {
      bytes += static_cast<int64_t>(entry.file_size());
    }
    return bytes;
  }

  RestartablePoised poised_;
  std::string content_;
  std::string name_;
};

TEST_F(ServerRestartTest, AnUploadGoesOnThoughItsServerIsKilledTwice) {
  poised_.Start("artifacts.after_append=kill:40");  // of 192 chunks
  const auto client = Connect();
  StatusOr<StoredArtifact> stored;
  std::thread uploader([&] { stored = client->Upload(content_); });
  poised_.RestartWhenKilled("artifacts.after_append=kill:70");
  EXPECT_EQ(UnfinishedBytes(), 39 * kMiB / 2) << "the first message has no bytes";
  poised_.RestartWhenKilled();
  uploader.join();
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_EQ(stored->name, name_);
  const int64_t again = stored->sent_bytes - kFileBytes;
  std::printf("sent again after 2 kills: %ld KiB\n", static_cast<long>(again >> 10));
  EXPECT_LE(again, 2 * kMiB) << "a chunk for each kill";
  EXPECT_TRUE(IsStored(*client));
  EXPECT_EQ(UnfinishedBytes(), 0);
}

TEST_F(ServerRestartTest, AnUploadFromAFileGoesOnThoughItsServerIsKilledAtAnyMoment) {
  poised_.Start("artifacts.after_append=sleep:3");
  const fs::path file = poised_.data_dir() / "file";
  std::ofstream(file, std::ios::binary) << content_;
  const auto client = Connect();
  StatusOr<StoredArtifact> stored;
  std::atomic<bool> done = false;
  std::thread uploader([&] {
    stored = client->UploadFile(file);
    done = true;
  });
  int kills = 0;
  for (const int64_t at : {5 * kMiB, 31 * kMiB, 77 * kMiB}) {
    while (!done && UnfinishedBytes() < at) absl::SleepFor(absl::Milliseconds(1));
    if (done) break;
    poised_.Kill();
    ++kills;
    poised_.Start("artifacts.after_append=sleep:3");
  }
  uploader.join();
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_EQ(stored->name, name_);
  ASSERT_EQ(kills, 3);
  const int64_t again = stored->sent_bytes - kFileBytes;
  std::printf("sent again after 3 kills: %ld KiB\n", static_cast<long>(again >> 10));
  EXPECT_LE(again, 3 * kMiB) << "a chunk for each kill";
  EXPECT_TRUE(IsStored(*client));
}

TEST_F(ServerRestartTest, AnUploadWhoseAnswerIsLostIsNotSentAgain) {
  poised_.Start("artifacts.after_commit=kill");
  const auto client = Connect();
  StatusOr<StoredArtifact> stored;
  std::thread uploader([&] { stored = client->Upload(content_); });
  poised_.RestartWhenKilled();
  uploader.join();
  ASSERT_TRUE(stored.ok()) << stored.status();
  EXPECT_EQ(stored->sent_bytes, kFileBytes);
  EXPECT_TRUE(IsStored(*client));
}

TEST_F(ServerRestartTest, ADownloadGoesOnThoughItsServerIsKilled) {
  poised_.Start();
  ASSERT_TRUE(Connect()->Upload(content_).ok());
  poised_.Kill();
  poised_.Start("artifacts.before_read=kill:50");
  const auto client = Connect();
  Status status;
  const fs::path file = poised_.data_dir() / "file";
  std::thread downloader([&] { status = client->DownloadFile(name_, file); });
  poised_.RestartWhenKilled("artifacts.before_read=kill:30");
  poised_.RestartWhenKilled();
  downloader.join();
  ASSERT_TRUE(status.ok()) << status;
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(std::string(std::istreambuf_iterator<char>(stream), {}) == content_);
  EXPECT_TRUE(IsStored(*client));
}

TEST_F(ServerRestartTest, WhoWaitsForAJobSeesEachStateOnceThoughTheServerIsKilled) {
  poised_.Start();
  const auto client = Connect();
  const auto job = client->CreateJob({.spec = {.kind = "selftest"}});
  ASSERT_TRUE(job.ok()) << job.status();
  std::vector<api::JobState> states;
  Status end;
  std::thread watcher([&] {
    const auto watch = client->WatchJob(job->id);
    while (true) {
      const auto event = watch->Next();
      end = event.status();
      if (!event.ok() || !event->has_value()) return;
      if ((*event)->state) states.push_back(*(*event)->state);
    }
  });
  for (int kill = 0; kill < 2; ++kill) {
    absl::SleepFor(absl::Milliseconds(300));
    poised_.Kill();
    poised_.Start();
  }
  const auto cancelled = client->CancelJob(job->id);
  watcher.join();
  EXPECT_TRUE(cancelled.ok()) << cancelled.status();
  EXPECT_TRUE(end.ok()) << end;
  EXPECT_EQ(states, (std::vector{api::JobState::kQueued, api::JobState::kCancelled}));
}

}  // namespace
}  // namespace poise::client
