#include <gmock/gmock.h>
#include <signal.h>

#include "absl/time/clock.h"
#include "tests/integration/worker_fixture.h"

namespace poise::worker {
namespace {

using testing::Eventually;

class WorkerFailureTest : public testing::WorkerFixture {
 protected:
  static std::vector<v1::JobAttempt::Outcome> Outcomes(const v1::Job& job) {
    std::vector<v1::JobAttempt::Outcome> outcomes;
    for (const v1::JobAttempt& attempt : job.attempts()) outcomes.push_back(attempt.outcome());
    return outcomes;
  }
};

TEST_F(WorkerFailureTest, PoisonJobEndsFailedWithAllAttemptsAndTheWorkerStaysUp) {
  StartServer();
  const auto worker = StartWorker();
  v1::JobLimits limits;
  limits.set_max_losses(3);
  for (const char* failure : {"segfault", "crash", "exit"}) {
    const v1::Job job = WaitForEnd(Submit({{"fail_at", 5}, {"failure", failure}}, limits));
    EXPECT_EQ(job.state(), v1::Job::FAILED);
    EXPECT_EQ(job.error().reason(), "PROCESS_LOST");
    EXPECT_EQ(Outcomes(job), std::vector(3, v1::JobAttempt::LOST));
    EXPECT_EQ(job.losses(), 3);
  }
  EXPECT_EQ(WaitForEnd(Submit({{"steps", 3}})).state(), v1::Job::SUCCEEDED);
  EXPECT_FALSE(worker->process.Wait(absl::ZeroDuration()).has_value());
}

TEST_F(WorkerFailureTest, ErrorsAreTriedAgainOnlyWhereThatMayCureThem) {
  StartServer();
  const auto worker = StartWorker();
  const v1::Job cured =
      WaitForEnd(Submit({{"fail_at", 5}, {"failure", "unavailable"}, {"fail_attempts", 2}}));
  EXPECT_EQ(cured.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(cured.attempt(), 3);
  EXPECT_EQ(cured.errors(), 2);
  const v1::Job memory =
      WaitForEnd(Submit({{"fail_at", 5}, {"failure", "out_of_memory"}, {"fail_attempts", 1}}));
  EXPECT_EQ(memory.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(memory.attempts(0).error().reason(), "OUT_OF_MEMORY");
  for (const auto& [failure, reason] :
       std::map<std::string, std::string>{{"invalid", "SELFTEST_INVALID"},
                                          {"diverge", "DIVERGED"},
                                          {"throw", "UNCAUGHT_EXCEPTION"}}) {
    const v1::Job job = WaitForEnd(Submit({{"fail_at", 5}, {"failure", failure}}));
    EXPECT_EQ(job.state(), v1::Job::FAILED);
    EXPECT_EQ(job.error().reason(), reason);
    EXPECT_EQ(job.attempt(), 1) << failure;
  }
}

TEST_F(WorkerFailureTest, EndlessLoopIsStalled) {
  StartServer();
  const auto worker = StartWorker();
  v1::JobLimits limits;
  limits.mutable_stall_timeout()->set_nanos(700'000'000);
  limits.set_max_errors(2);
  const v1::Job job =
      WaitForEnd(Submit({{"fail_at", 5}, {"failure", "hang"}, {"busy", true}}, limits));
  EXPECT_EQ(job.state(), v1::Job::FAILED);
  EXPECT_EQ(job.error().reason(), "STALLED");
  EXPECT_EQ(Outcomes(job), std::vector(2, v1::JobAttempt::STALLED));
  EXPECT_EQ(job.attempts(0).last_step(), 5);
  EXPECT_TRUE(Eventually([&] { return !worker->HasChildren(); }, absl::Seconds(5)));
}

TEST_F(WorkerFailureTest, DeadlineEndsARunningJob) {
  StartServer();
  const auto worker = StartWorker();
  v1::JobLimits limits;
  limits.mutable_deadline()->set_seconds(2);
  const v1::Job job = WaitForEnd(Submit({{"steps", 1'000'000}}, limits));
  EXPECT_EQ(job.state(), v1::Job::FAILED);
  EXPECT_EQ(job.error().reason(), "DEADLINE_EXCEEDED");
  EXPECT_TRUE(Eventually([&] { return !worker->HasChildren(); }, absl::Seconds(5)));
}

TEST_F(WorkerFailureTest, KilledWorkerTakesItsChildrenAlongAndAnotherGoesOn) {
  StartServer();
  auto undisturbed_worker = StartWorker();
  const base::Json parameters = {
      {"steps", 400}, {"step_ms", 10}, {"checkpoint_every", 10}, {"artifacts", 2}};
  const v1::Job undisturbed = WaitForEnd(Submit(parameters));
  undisturbed_worker.reset();
  const auto first = StartWorker();
  const std::string name = Submit(parameters);
  WaitFor(name, [](const v1::Job& job) { return job.checkpoint().step() >= 50; });
  const std::vector<pid_t> children = first->Children();
  ASSERT_EQ(children.size(), 1u);
  first->process.Signal(SIGKILL);
  EXPECT_TRUE(Eventually([&] { return kill(children[0], 0) != 0; }, absl::Seconds(5)));
  const auto second = StartWorker();
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(Outcomes(job), (std::vector{v1::JobAttempt::LOST, v1::JobAttempt::SUCCEEDED}));
  EXPECT_GE(job.attempts(1).from_step(), 50);
  EXPECT_EQ(Artifacts(job), Artifacts(undisturbed));
}

TEST_F(WorkerFailureTest, SilentServerMakesTheWorkerGiveUpByItsOwnClock) {
  StartServer();
  const auto worker = StartWorker();
  const std::string name = Submit({{"steps", 200}, {"step_ms", 20}, {"busy", true}});
  WaitForStep(name, 20);
  server_->Signal(SIGSTOP);  // the connection stays, no answer comes
  EXPECT_TRUE(Eventually([&] { return !worker->HasChildren(); }, absl::Seconds(30)));
  server_->Signal(SIGCONT);
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(Outcomes(job), (std::vector{v1::JobAttempt::LOST, v1::JobAttempt::SUCCEEDED}));
}

TEST_F(WorkerFailureTest, PausedWorkerThrowsItsWorkAway) {
  StartServer();
  const auto paused = StartWorker();
  const std::string name = Submit({{"steps", 200}, {"step_ms", 20}});
  WaitForStep(name, 20);
  paused->process.Signal(SIGSTOP);
  const auto other = StartWorker();
  WaitFor(name, [](const v1::Job& job) { return job.attempt() == 2; });
  paused->process.Signal(SIGCONT);
  EXPECT_TRUE(Eventually([&] { return !paused->HasChildren(); }, absl::Seconds(10)));
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.attempt(), 2);
  EXPECT_THAT(paused->process.ErrorOutput(), ::testing::HasSubstr("lease_lost"));
}

TEST_F(WorkerFailureTest, DeathAroundTheEndNeitherLosesNorDoublesTheResult) {
  StartServer();
  for (const char* point : {"worker.after_lease", "worker.before_finish", "worker.after_finish"}) {
    const auto dies = StartWorker({}, {{"POISE_FAIL_POINTS", std::string(point) + "=kill:1"}});
    const std::string name = Submit({{"steps", 5}});
    EXPECT_EQ(dies->process.Wait(), -SIGKILL) << point;
    const auto other = StartWorker();
    const v1::Job job = WaitForEnd(name);
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << point;
    const bool told = std::string_view(point) == "worker.after_finish";
    EXPECT_EQ(job.attempt(), told ? 1 : 2) << point;
  }
}

TEST_F(WorkerFailureTest, DeathBeforeACheckpointIsCommittedLeavesThePreviousOne) {
  StartServer();
  const auto dies =
      StartWorker({}, {{"POISE_FAIL_POINTS", "worker.before_checkpoint_commit=kill:3"}});
  const std::string name = Submit({{"steps", 60}, {"step_ms", 50}, {"checkpoint_every", 10}});
  EXPECT_EQ(dies->process.Wait(), -SIGKILL);
  EXPECT_EQ(Get(name).checkpoint().step(), 20);
  const auto other = StartWorker();
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.attempts(1).from_step(), 20);
}

TEST_F(WorkerFailureTest, FolderOfAKilledWorkerIsRemovedByTheNext) {
  StartServer();
  const auto killed = StartWorker({"--id", "killed"});
  const std::string name = Submit({{"steps", 1'000'000}});
  WaitForStep(name, 3);
  killed->process.Signal(SIGKILL);
  killed->process.Wait();
  ASSERT_TRUE(std::filesystem::exists(folder_.path() / "work" / "killed"));
  const auto next = StartWorker({"--id", "next"});
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "work" / "killed"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "work" / "next"));
}

}  // namespace
}  // namespace poise::worker
