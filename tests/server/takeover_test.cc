#include <gtest/gtest.h>
#include <signal.h>

#include <future>

#include "tests/support/job_client.h"
#include "tests/support/server_process.h"
#include "tests/support/temporary_folder.h"

namespace poise::server {
namespace {

using testing::JobClient;
using testing::ServerProcess;

// poised on a data folder that others use too.
struct Shared {
  std::vector<std::string> Flags(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"--data-dir", folder.path().string(), "--lame-duck-seconds", "0"});
    return more;
  }
  testing::TemporaryFolder folder;
};

TEST(TakeoverTest, SecondServerOnADataFolderEndsAtOnceAndLeavesTheFirstAlone) {
  const Shared shared;
  ServerProcess first(shared.Flags());
  const JobClient client(first.NewChannel());
  ASSERT_TRUE(client.Create(testing::SelftestRequest()).ok());
  ServerProcess second(shared.Flags());
  EXPECT_TRUE(second.ready().empty());
  EXPECT_EQ(second.Wait(), 4);
  EXPECT_NE(second.Log().find("another process uses the job store"), std::string::npos);
  EXPECT_EQ(client.List({})->jobs_size(), 1);
  EXPECT_TRUE(client.Create(testing::SelftestRequest()).ok());
}

TEST(TakeoverTest, SecondServerWaitsForTheFirstToEndAndGoesOnWithItsJobs) {
  const Shared shared;
  ServerProcess first(shared.Flags());
  const std::string name = JobClient(first.NewChannel()).Create(testing::SelftestRequest())->name();
  auto second = std::async(std::launch::async, [&] {
    return std::make_unique<ServerProcess>(shared.Flags({"--takeover-seconds", "60"}));
  });
  EXPECT_EQ(second.wait_for(std::chrono::milliseconds(500)), std::future_status::timeout);
  first.Signal(SIGTERM);
  const std::unique_ptr<ServerProcess> server = second.get();
  ASSERT_FALSE(server->ready().empty()) << server->Log();
  EXPECT_EQ(first.Wait(), 0);
  EXPECT_EQ(JobClient(server->NewChannel()).Get(name)->state(), v1::Job::QUEUED);
}

}  // namespace
}  // namespace poise::server
