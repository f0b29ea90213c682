#include <gmock/gmock.h>
#include <signal.h>

#include "absl/time/clock.h"
#include "tests/integration/worker_fixture.h"
#include "tests/support/sanitizer.h"

namespace poise::worker {
namespace {

using testing::Eventually;

class WorkerDrainTest : public testing::WorkerFixture {};

TEST_F(WorkerDrainTest, TenDrainsAreFreeOfChargeAndLoseNoStep) {
  StartServer();
  const base::Json parameters = {{"steps", 3000}, {"step_ms", 0}, {"artifacts", 2}};
  const std::string undisturbed = Submit(parameters);
  {
    const auto worker = StartWorker();
    WaitForEnd(undisturbed);
  }
  base::Json slowly = parameters;
  slowly["step_ms"] = 5;
  const std::string name = Submit(slowly);
  int64_t step = 0;
  for (int i = 0; i < 10; ++i) {
    const auto worker = StartWorker();
    WaitForStep(name, step + 1);
    const absl::Time asked = absl::Now();
    worker->process.Signal(SIGTERM);
    EXPECT_EQ(worker->process.Wait(), 0);
    EXPECT_LT(absl::Now() - asked, absl::Seconds(20));
    const v1::Job job = Get(name);
    EXPECT_EQ(job.state(), v1::Job::QUEUED);
    EXPECT_GT(job.checkpoint().step(), step);
    step = job.checkpoint().step();
    ASSERT_EQ(job.attempts_size(), i + 1);
    EXPECT_EQ(job.attempts(i).outcome(), v1::JobAttempt::RELEASED);
    EXPECT_EQ(job.attempts(i).last_step(), step);
  }
  const auto worker = StartWorker();
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.errors(), 0);
  EXPECT_EQ(job.losses(), 0);
  EXPECT_EQ(job.attempt(), 11);
  auto artifacts = Artifacts(job);
  auto expected = Artifacts(Get(undisturbed));
  for (auto* files : {&artifacts, &expected}) files->erase("manifest.json");  // names the pace
  EXPECT_EQ(artifacts, expected);
}

TEST_F(WorkerDrainTest, IdleWorkerLeavesAtOnce) {
  StartServer();
  const auto worker = StartWorker({"--slots", "3"});
  const absl::Time asked = absl::Now();
  worker->process.Signal(SIGTERM);
  EXPECT_EQ(worker->process.Wait(), 0);
  EXPECT_LT(absl::Now() - asked, absl::Seconds(5));  // not as long as its polls
}

TEST_F(WorkerDrainTest, WorkerWithoutAServerLeavesToo) {
  StartServer();
  const auto worker = StartWorker();
  server_->Signal(SIGKILL);
  server_->Wait();
  worker->process.Signal(SIGTERM);
  EXPECT_EQ(worker->process.Wait(), 0);
  testing::Process never({POISE_WORKER_PROGRAM, "--server", address_});
  absl::SleepFor(absl::Seconds(testing::kInstrumented ? 4 : 1));  // until it tries to connect
  never.Signal(SIGTERM);
  EXPECT_EQ(never.Wait(), 0);
}

TEST_F(WorkerDrainTest, SecondSignalHurriesAChildThatWillNotStop) {
  StartServer();
  const auto worker = StartWorker();
  const std::string name = Submit({{"steps", 1'000'000}, {"on_stop", "ignore"}});
  WaitForStep(name, 3);
  worker->process.Signal(SIGTERM);
  EXPECT_FALSE(worker->process.Wait(absl::Seconds(2)).has_value());  // within drain_grace
  const absl::Time asked = absl::Now();
  worker->process.Signal(SIGTERM);
  EXPECT_EQ(worker->process.Wait(), 0);
  EXPECT_LT(absl::Now() - asked, absl::Seconds(6));
  WaitForState(name, v1::Job::QUEUED);
  EXPECT_EQ(Get(name).losses(), 0);
}

TEST_F(WorkerDrainTest, CancelWhileDrainingEndsCancelled) {
  StartServer();
  const auto worker = StartWorker();
  const std::string name = Submit({{"steps", 1'000'000}, {"on_stop", "ignore"}});
  WaitForStep(name, 3);
  worker->process.Signal(SIGTERM);
  absl::SleepFor(absl::Milliseconds(300));
  ASSERT_TRUE(client_->Cancel(name).ok());
  EXPECT_EQ(WaitForEnd(name).state(), v1::Job::CANCELLED);
  EXPECT_EQ(worker->process.Wait(), 0);
}

TEST_F(WorkerDrainTest, WorkerWithNothingToDoEndsByItself) {
  StartServer();
  const auto worker = StartWorker({"--idle-exit", "2s"});
  const std::string name = Submit({{"steps", 30}, {"step_ms", 100}});  // longer than that
  EXPECT_EQ(WaitForEnd(name).state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(worker->process.Wait(), 0);
  EXPECT_EQ(Get(name).attempt(), 1);
}

TEST_F(WorkerDrainTest, WorkerWhoseTimeIsOverGivesItsJobBack) {
  StartServer();
  const std::string name = Submit({{"steps", 1'000'000}});
  const auto worker = StartWorker({"--max-time", "2"});
  EXPECT_EQ(worker->process.Wait(), 0);
  const v1::Job job = Get(name);
  EXPECT_EQ(job.state(), v1::Job::QUEUED);
  EXPECT_EQ(job.attempts(0).outcome(), v1::JobAttempt::RELEASED);
  EXPECT_GT(job.checkpoint().step(), 0);
}

}  // namespace
}  // namespace poise::worker
