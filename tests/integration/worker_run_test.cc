#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <fstream>

#include "absl/time/clock.h"
#include "tests/integration/worker_fixture.h"

namespace poise::worker {
namespace {

using testing::Eventually;

class WorkerRunTest : public testing::WorkerFixture {};

TEST_F(WorkerRunTest, JobsRunToTheirResultsOnAllSlots) {
  StartServer();
  const auto worker = StartWorker({"--slots", "2", "--id", "worker-of-this-test"});
  const base::Json ready = base::Json::parse(worker->process.Output());
  EXPECT_EQ(ready["event"], "ready");
  EXPECT_EQ(ready["worker"], "worker-of-this-test");
  EXPECT_EQ(ready["server"], address_);
  std::vector<std::string> names;
  for (int i = 0; i < 4; ++i) {
    names.push_back(Submit({{"steps", 50}, {"step_ms", 10}, {"busy", true}, {"artifacts", 3}}));
  }
  EXPECT_TRUE(Eventually([&] { return worker->Children().size() == 2; }, absl::Seconds(30)));
  for (const std::string& name : names) {
    const v1::Job job = WaitForEnd(name);
    EXPECT_EQ(job.state(), v1::Job::SUCCEEDED) << job.DebugString();
    ASSERT_EQ(job.attempts_size(), 1);
    const v1::JobAttempt& attempt = job.attempts(0);
    EXPECT_EQ(attempt.outcome(), v1::JobAttempt::SUCCEEDED);
    EXPECT_EQ(attempt.worker(), "worker-of-this-test");
    EXPECT_EQ(attempt.last_step(), 50);
    EXPECT_GT(attempt.cpu_seconds(), 0.1);
    EXPECT_GT(attempt.peak_memory_bytes(), 1'000'000);
    EXPECT_EQ(job.artifacts_size(), 4);
    EXPECT_TRUE(Artifacts(job).contains("manifest.json"));
    EXPECT_EQ(Artifacts(job).at("manifest.json"), Artifacts(Get(names[0])).at("manifest.json"));
  }
  EXPECT_TRUE(Eventually([&] { return !worker->HasChildren(); }, absl::Seconds(5)));
}

TEST_F(WorkerRunTest, ChildStartsOnceWithWhatLibTorchNeedsAndWithoutTheToken) {
  StartServer(ShortLeases(), {{"POISE_TOKEN", ""}});
  const auto worker = StartWorker({}, {{"POISE_TOKEN", "unused"}});
  const std::string name = Submit({{"steps", 1'000'000}});
  WaitForStep(name, 3);
  ASSERT_EQ(worker->Children().size(), 1u);
  std::ifstream file("/proc/" + std::to_string(worker->Children()[0]) + "/environ");
  std::vector<std::string> variables;
  for (std::string variable; std::getline(file, variable, '\0');) variables.push_back(variable);
  const auto count = [&](const std::string& prefix) {
    return std::count_if(variables.begin(), variables.end(),
                         [&](const std::string& text) { return text.starts_with(prefix); });
  };
  // The worker itself was started again with these; with them a program does not start twice.
  EXPECT_EQ(count("OPENBLAS_CORETYPE="), 1);
  EXPECT_EQ(count("OMP_WAIT_POLICY="), 1);
  EXPECT_EQ(count("POISE_TOKEN="), 0);
}

TEST_F(WorkerRunTest, CancelEndsTheChildWithinTwoSeconds) {
  StartServer();
  const auto worker = StartWorker();
  for (const char* on_stop : {"obey", "ignore"}) {
    const std::string name =
        Submit({{"steps", 1'000'000}, {"step_ms", 10}, {"busy", true}, {"on_stop", on_stop}});
    WaitForStep(name, 20);
    ASSERT_TRUE(worker->HasChildren());
    const absl::Time asked = absl::Now();
    ASSERT_TRUE(client_->Cancel(name).ok());
    EXPECT_TRUE(Eventually([&] { return !worker->HasChildren(); }, absl::Seconds(20)));
    const double seconds = absl::ToDoubleSeconds(absl::Now() - asked);
    std::printf("cancel, on_stop=%s: child gone after %.2f s\n", on_stop, seconds);
    EXPECT_LT(seconds, 2.0) << on_stop;
    const v1::Job job = WaitForEnd(name);
    EXPECT_EQ(job.state(), v1::Job::CANCELLED);
    EXPECT_EQ(job.attempts(0).outcome(), v1::JobAttempt::CANCELLED);
    EXPECT_EQ(job.has_checkpoint(), std::string_view(on_stop) == "obey");
  }
  EXPECT_EQ(WaitForEnd(Submit({{"steps", 3}})).state(), v1::Job::SUCCEEDED);
}

TEST_F(WorkerRunTest, HealthyJobOfTenLeasesHasOneAttempt) {
  StartServer({"--lease-seconds", "1", "--heartbeat-seconds", "0.3", "--reap-seconds", "0.1"});
  const auto worker = StartWorker();
  const v1::Job job = WaitForEnd(Submit({{"steps", 100}, {"step_ms", 100}}));
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.attempt(), 1);
  EXPECT_EQ(job.losses(), 0);
}

TEST_F(WorkerRunTest, ServerThatRestartsWithinTheLeaseFindsTheSameAttempt) {
  StartServer({"--lease-seconds", "20", "--heartbeat-seconds", "1"});
  const auto worker = StartWorker();
  const std::string name = Submit({{"steps", 400}, {"step_ms", 10}, {"checkpoint_every", 20}});
  WaitForStep(name, 20);
  server_->Signal(SIGKILL);
  server_->Wait();
  absl::SleepFor(absl::Seconds(1));
  StartServer({"--lease-seconds", "20", "--heartbeat-seconds", "1"});
  const v1::Job job = WaitForEnd(name);
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.attempt(), 1);
}

TEST_F(WorkerRunTest, LostAnswerToALeaseDoesNotStrandTheJob) {
  StartServer({"--lease-seconds", "60"}, {{"POISE_FAIL_POINTS", "jobs.after_claim=kill:1"}});
  const auto worker = StartWorker();
  const std::string name = Submit({{"steps", 5}});
  EXPECT_EQ(server_->Wait(), -SIGKILL);
  StartServer({"--lease-seconds", "60"});
  const v1::Job job = WaitForEnd(name);  // long before the lease of the lost answer ends
  EXPECT_EQ(job.state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(job.attempt(), 1);
}

TEST_F(WorkerRunTest, ServerThatForgotTheWorkerIsToldAgain) {
  StartServer();
  const auto worker = StartWorker();
  server_->Signal(SIGKILL);
  server_->Wait();
  std::filesystem::remove_all(folder_.path() / "data");
  StartServer();
  EXPECT_EQ(WaitForEnd(Submit({{"steps", 3}})).state(), v1::Job::SUCCEEDED);
}

TEST_F(WorkerRunTest, KindsAndQueuesOfOthersAreLeftAlone) {
  StartServer();
  const auto worker = StartWorker({"--queues", "night,weekend"});
  const std::string name = Submit({{"steps", 3}});
  absl::SleepFor(absl::Seconds(1));
  EXPECT_EQ(Get(name).state(), v1::Job::QUEUED);
  const auto all = StartWorker();
  EXPECT_EQ(WaitForEnd(name).state(), v1::Job::SUCCEEDED);
}

TEST_F(WorkerRunTest, WorkerWithoutTheTokenEndsWithANamedError) {
  StartServer(ShortLeases(), {{"POISE_TOKEN", "secret"}});
  testing::Process worker({POISE_WORKER_PROGRAM, "--server", address_});
  EXPECT_EQ(worker.Wait(), 4);
  EXPECT_THAT(worker.ErrorOutput(), ::testing::HasSubstr("token"));
}

TEST_F(WorkerRunTest, BadFlagsEndWithUsageErrors) {
  const auto run = [](std::vector<std::string> flags) {
    flags.insert(flags.begin(), POISE_WORKER_PROGRAM);
    return testing::Process(flags).Wait();
  };
  EXPECT_EQ(run({"--slots", "0"}), 2);
  EXPECT_EQ(run({"--idle-exit", "soon"}), 2);
  EXPECT_EQ(run({"--engine", "steam"}), 2);
  EXPECT_EQ(run({"--kinds", "selftset"}), 2);
  EXPECT_EQ(run({"--id", "../x"}), 2);
  EXPECT_EQ(run({"--work-dir", "/proc/nowhere", "--server", "127.0.0.1:1"}), 4);
}

}  // namespace
}  // namespace poise::worker
