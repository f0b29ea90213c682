#include <gmock/gmock.h>
#include <signal.h>

#include "absl/time/clock.h"
#include "server/local_workers.h"
#include "tests/integration/worker_fixture.h"
#include "tests/support/process_inspection.h"

namespace poise::worker {
namespace {

using testing::ChildrenOf;
using testing::Eventually;

// The workers that poised --workers starts.
class WorkerPoolTest : public testing::WorkerFixture {
 protected:
  static Flags LongLeases() {
    return {"--workers",           "2",   "--lease-seconds", "60", "--heartbeat-seconds", "1",
            "--lame-duck-seconds", "0.1", "--drain-seconds", "20"};
  }
  pid_t WorkerPid() {
    std::vector<pid_t> workers;
    Eventually([&] { return !(workers = ChildrenOf(server_pid())).empty(); }, absl::Seconds(20));
    return workers.empty() ? -1 : workers[0];
  }
};

TEST_F(WorkerPoolTest, RunsJobsAndForwardsItsLog) {
  StartServer(LongLeases(), {{"POISE_TOKEN", ""}});
  const v1::Job job = WaitForEnd(Submit({{"steps", 20}}));
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_TRUE(job.attempts(0).worker().starts_with("local-"));
  EXPECT_THAT(server_->ErrorOutput(), ::testing::HasSubstr("attempt_end"));
  EXPECT_EQ(ChildrenOf(server_pid()).size(), 1u);
}

TEST_F(WorkerPoolTest, KilledWorkerIsReplacedAndItsJobsRunAtOnce) {
  StartServer(LongLeases());
  const std::string name = Submit({{"steps", 300}, {"step_ms", 10}, {"checkpoint_every", 10}});
  WaitForStep(name, 50);
  kill(WorkerPid(), SIGKILL);
  const v1::Job job = WaitFor(
      name, [](const v1::Job& job) { return job.state() == v1::Job::SUCCEEDED; },
      absl::Seconds(50));  // the lease ends later
  EXPECT_EQ(job.attempt(), 2);
  EXPECT_EQ(job.attempts(0).outcome(), v1::JobAttempt::LOST);
  EXPECT_GE(job.attempts(1).from_step(), 10);
}

TEST_F(WorkerPoolTest, DrainOfTheServerGivesTheJobsBackAndTheNextServerGoesOn) {
  StartServer(LongLeases());
  const std::string name = Submit({{"steps", 800}, {"step_ms", 5}});
  WaitForStep(name, 50);
  server_->Signal(SIGTERM);
  EXPECT_EQ(server_->Wait(), 0);
  StartServer(LongLeases());
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.losses(), 0);
  ASSERT_EQ(job.attempts_size(), 2);
  EXPECT_EQ(job.attempts(0).outcome(), v1::JobAttempt::RELEASED);
  EXPECT_GE(job.attempts(1).from_step(), 50);
}

TEST_F(WorkerPoolTest, NothingOutlivesAServerThatIsKilled) {
  StartServer(LongLeases());
  const std::string name = Submit({{"steps", 1'000'000}});
  WaitForStep(name, 3);
  const pid_t worker = WorkerPid();
  const std::vector<pid_t> children = ChildrenOf(worker);
  ASSERT_EQ(children.size(), 1u);
  server_->Signal(SIGKILL);
  server_->Wait();
  const auto gone = [](pid_t pid) { return kill(pid, 0) != 0; };
  EXPECT_TRUE(Eventually([&] { return gone(worker) && gone(children[0]); }, absl::Seconds(5)));
}

TEST_F(WorkerPoolTest, JobsOfAKilledServersWorkersGoOnAtOnceWithTheNextServer) {
  StartServer(LongLeases());
  const std::string name = Submit({{"steps", 1'000'000}});
  WaitForStep(name, 3);
  server_->Signal(SIGKILL);
  server_->Wait();
  StartServer(LongLeases());
  const v1::Job job = WaitFor(
      name, [](const v1::Job& now) { return now.attempt() == 2; }, absl::Seconds(20));
  EXPECT_EQ(job.losses(), 1);
}

TEST_F(WorkerPoolTest, WorkersHaveTheServersToken) {
  StartServer(LongLeases(), {{"POISE_TOKEN", "secret"}});
  WorkerPid();
  EXPECT_TRUE(
      Eventually([&] { return server_->ErrorOutput().find("\"worker\"") != std::string::npos; },
                 absl::Seconds(20)));
  EXPECT_THAT(server_->ErrorOutput(), ::testing::HasSubstr("\"event\":\"ready\""));
  EXPECT_THAT(server_->ErrorOutput(), ::testing::Not(::testing::HasSubstr("secret")));
}

TEST(LoopbackAddressTest, AnyAddressIsReachedByLoopback) {
  EXPECT_EQ(server::LoopbackAddress("0.0.0.0:50051"), "127.0.0.1:50051");
  EXPECT_EQ(server::LoopbackAddress("[::]:50051"), "[::1]:50051");
  EXPECT_EQ(server::LoopbackAddress("10.0.0.1:50051"), "10.0.0.1:50051");
}

}  // namespace
}  // namespace poise::worker
