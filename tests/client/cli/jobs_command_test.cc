// `poise jobs` against a server whose jobs do what the test says.
#include <gmock/gmock.h>
#include <signal.h>

#include <thread>

#include "absl/time/clock.h"
#include "tests/client/cli/poise_program.h"
#include "tests/client/fake_jobs.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace poise::testing {
namespace {

using api::JobState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class JobsCommandTest : public ::testing::Test {
 protected:
  JobsCommandTest() : server_(jobs_, artifacts_) {}

  PoiseRun Jobs(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "jobs");
    return RunPoise(std::move(arguments), {{"POISE_SERVER", server_.address}});
  }
  // `poise jobs ...` that runs beside the test.
  std::unique_ptr<Process> Start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {ProgramPath("poise"), "jobs"});
    return std::make_unique<Process>(
        arguments, std::map<std::string, std::string>{{"POISE_SERVER", server_.address}});
  }
  std::string Ended(JobState state, absl::StatusCode code = {}) {
    const std::string id = jobs_.Add(JobState::kQueued);
    jobs_.SetState(id, JobState::kRunning);
    jobs_.SetState(id, state, code);
    return id;
  }
  // As a watch that has joined.
  void AwaitJoin() const {
    while (jobs_.joins.empty()) absl::SleepFor(absl::Milliseconds(1));
  }

  FakeJobs jobs_;
  FakeArtifacts artifacts_;
  FakeServer server_;
};

TEST_F(JobsCommandTest, CreateSendsEverythingThatWasAskedFor) {
  const PoiseRun run =
      Jobs({"create",       "selftest",  "--param",      "steps=7", "--param", "on_stop=obey",
            "--param",      "busy=true", "--request-id", "r1",      "--seed",  "9",
            "--priority",   "-2",        "--queue",      "q",       "--label", "run=7",
            "--max-errors", "1",         "--deadline",   "60",      "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_EQ(run.JsonLines().back()["state"], "QUEUED");
  EXPECT_EQ(run.JsonLines().back()["request_id"], "r1");
  ASSERT_THAT(jobs_.creates, SizeIs(1));
  const v1::CreateJobRequest& request = jobs_.creates[0];
  const auto& parameters = request.spec().parameters().fields();
  EXPECT_EQ(parameters.at("steps").number_value(), 7);
  EXPECT_EQ(parameters.at("on_stop").string_value(), "obey");
  EXPECT_TRUE(parameters.at("busy").bool_value());
  EXPECT_EQ(request.seed(), 9u);
  EXPECT_EQ(request.priority(), -2);
  EXPECT_EQ(request.queue(), "q");
  EXPECT_EQ(request.labels().at("run"), "7");
  EXPECT_EQ(request.limits().max_errors(), 1);
  EXPECT_EQ(request.limits().deadline().seconds(), 60);
}

TEST_F(JobsCommandTest, TheSameRequestIdIsTheSameJob) {
  const std::string first = Jobs({"create", "selftest", "--request-id", "r1"}).out;
  EXPECT_THAT(first, ::testing::StartsWith("jobs/"));
  EXPECT_EQ(Jobs({"create", "selftest", "--request-id", "r1"}).out, first);
  EXPECT_NE(Jobs({"create", "selftest"}).out, first);
}

TEST_F(JobsCommandTest, MistakesAreToldWithTheirField) {
  PoiseRun run = Jobs({"create", "selftest", "--param", "steps", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error()["field"], "param");
  run = Jobs({"create", "selftest", "--priority", "11", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error()["reason"], "BAD_PRIORITY");
  run = Jobs({"get", "nowhere", "--json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.Error()["reason"], "JOB_NOT_FOUND");
  run = Jobs({"get", "jobs/", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error()["reason"], "BAD_JOB_NAME");
  run = Jobs({"list", "--state", "BROKEN", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.Error()["reason"], "UNKNOWN_JOB_STATE");
}

TEST_F(JobsCommandTest, WaitingTellsByItsExitCodeHowTheJobEnded) {
  const auto create = [&](JobState end, absl::StatusCode code) {
    const std::string request_id = "r" + std::to_string(jobs_.creates.size());
    const auto process =
        Start({"create", "selftest", "--request-id", request_id, "--wait", "--json"});
    AwaitJoin();
    jobs_.joins.clear();
    const base::Json listed = Jobs({"list", "--limit", "1", "--json"}).JsonLines().at(0);
    jobs_.SetState(std::string(listed["name"]).substr(5), end, code);
    const int exit_code = process->Wait().value_or(-1);
    // One line, the job at its end; a job that failed is no error of the command.
    const base::Json job = base::Json::parse(process->Output());
    EXPECT_EQ(job["request_id"], request_id);
    EXPECT_EQ(job["state"], api::JobStateName(end));
    return exit_code;
  };
  EXPECT_EQ(create(JobState::kSucceeded, {}), 0);
  EXPECT_EQ(create(JobState::kFailed, absl::StatusCode::kOutOfRange), 8);
  EXPECT_EQ(create(JobState::kCancelled, absl::StatusCode::kCancelled), 6);
}

TEST_F(JobsCommandTest, WaitingGivesUpInTimeAndLeavesTheJob) {
  const PoiseRun run = Jobs({"create", "selftest", "--wait", "--timeout", "0.3", "--json"});
  EXPECT_EQ(run.exit_code, 6);
  EXPECT_EQ(run.Error()["reason"], "DEADLINE_EXCEEDED");
  EXPECT_EQ(Jobs({"list", "--json"}).JsonLines().at(0)["state"], "QUEUED");
}

TEST_F(JobsCommandTest, ListPagesFiltersAndTellsThatThereIsMore) {
  for (int i = 0; i < 4; ++i) jobs_.Add(JobState::kQueued);
  const std::string failed = Ended(JobState::kFailed, absl::StatusCode::kInternal);
  EXPECT_THAT(Jobs({"list", "--json"}).JsonLines(), SizeIs(5));
  EXPECT_THAT(Jobs({"list", "--limit", "3", "--json"}).JsonLines(), SizeIs(3));
  const auto lines = Jobs({"list", "--state", "FAILED", "--json"}).JsonLines();
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_EQ(lines[0]["name"], "jobs/" + failed);
  const PoiseRun table = Jobs({"list", "--limit", "3"});
  EXPECT_THAT(table.out, HasSubstr("jobs/" + failed));
  EXPECT_THAT(table.err, HasSubstr("more than 3"));
}

TEST_F(JobsCommandTest, WatchWritesALineForEachEvent) {
  const std::string id = Ended(JobState::kFailed, absl::StatusCode::kOutOfRange);
  const PoiseRun run = Jobs({"watch", "jobs/" + id, "--json"});
  EXPECT_EQ(run.exit_code, 8);
  std::vector<std::string> states;
  for (const base::Json& line : run.JsonLines()) states.push_back(line.at("state"));
  EXPECT_THAT(states, ElementsAre("QUEUED", "RUNNING", "FAILED"));
  EXPECT_EQ(run.Error()["reason"], "TOLD_TO");
}

TEST_F(JobsCommandTest, WatchOfSeveralJobsEndsWithTheWorst) {
  const std::string good = Ended(JobState::kSucceeded);
  const std::string cancelled = Ended(JobState::kCancelled);
  const std::string failed = Ended(JobState::kFailed, absl::StatusCode::kInternal);
  EXPECT_EQ(Jobs({"watch", good}).exit_code, 0);
  EXPECT_EQ(Jobs({"watch", good, cancelled}).exit_code, 6);
  const PoiseRun run = Jobs({"watch", cancelled, failed, good});
  EXPECT_EQ(run.exit_code, 8);
  EXPECT_THAT(run.err, HasSubstr("FAILED: it was told to"));
}

TEST_F(JobsCommandTest, WithoutATerminalWatchWritesPlainLines) {
  const std::string id = jobs_.Add(JobState::kQueued);
  jobs_.SetState(id, JobState::kRunning);
  for (int step = 1; step <= 100; ++step) jobs_.SetProgress(id, step, 100);
  jobs_.SetState(id, JobState::kSucceeded);
  const PoiseRun run = Jobs({"watch", id});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(run.out, HasSubstr("[##########..........]  50/100"));
  EXPECT_THAT(run.out, HasSubstr("SUCCEEDED"));
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 13) << "3 states and 10 tenths";
}

TEST_F(JobsCommandTest, OnATerminalTheLinesAreRedrawn) {
  const std::string id = jobs_.Add(JobState::kRunning);
  jobs_.SetProgress(id, 50, 100);
  Process terminal(
      {"/usr/bin/script", "-qec", ProgramPath("poise") + " jobs watch " + id, "/dev/null"},
      {{"POISE_SERVER", server_.address}, {"TERM", "xterm"}});
  AwaitJoin();
  absl::SleepFor(absl::Milliseconds(300));
  jobs_.SetProgress(id, 100, 100);
  absl::SleepFor(absl::Milliseconds(300));
  jobs_.SetState(id, JobState::kSucceeded);
  EXPECT_EQ(terminal.Wait(), 0);
  EXPECT_THAT(terminal.Output(), HasSubstr("RUNNING"));
  EXPECT_THAT(terminal.Output(), HasSubstr("[####################]  100/100"));
  EXPECT_THAT(terminal.Output(), HasSubstr("\x1b[1A")) << "back over the line";
}

TEST_F(JobsCommandTest, CtrlCLeavesTheJobAndSaysHowToCancelIt) {
  const std::string id = jobs_.Add(JobState::kRunning);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"watch", id}, {"watch", id, "--json"}}) {
    jobs_.joins.clear();
    const auto process = Start(arguments);
    AwaitJoin();
    process->Signal(SIGINT);
    EXPECT_EQ(process->Wait(), 6);
    EXPECT_THAT(process->Output() + process->ErrorOutput(),
                HasSubstr("poise jobs cancel jobs/" + id));
    EXPECT_EQ(Jobs({"get", id, "--json"}).JsonLines().back()["state"], "RUNNING");
  }
}

TEST_F(JobsCommandTest, AServerThatIsGoneForAWhileIsNotTold) {
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto process = Start({"watch", id, "--json"});
  AwaitJoin();
  jobs_.cuts = {{0, grpc::Status(grpc::StatusCode::UNAVAILABLE, "away")}};
  jobs_.SetState(id, JobState::kSucceeded);
  EXPECT_EQ(process->Wait(), 0);
  EXPECT_THAT(process->ErrorOutput(), IsEmpty());
}

TEST_F(JobsCommandTest, ListWatchShowsChangesUntilAllIsDone) {
  const std::string id = jobs_.Add(JobState::kRunning);
  const auto process = Start({"list", "--watch", "--interval", "0.1"});
  ASSERT_TRUE(process->WaitForOutput("RUNNING", absl::Seconds(20)));
  jobs_.SetState(id, JobState::kSucceeded);
  EXPECT_EQ(process->Wait(), 0);
  EXPECT_THAT(process->Output(), HasSubstr("SUCCEEDED"));
  const std::string out = process->Output();
  EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 2) << out;
}

TEST_F(JobsCommandTest, CancelDeleteAndRetryAnswerWithTheJob) {
  const std::string id = jobs_.Add(JobState::kRunning);
  EXPECT_EQ(Jobs({"cancel", id, "--wait", "--json"}).JsonLines().back()["state"], "CANCELLED");
  const base::Json again = Jobs({"retry", id, "--request-id", "r2", "--json"}).JsonLines().back();
  EXPECT_EQ(again["retry_of"], "jobs/" + id);
  EXPECT_EQ(again["request_id"], "r2");
  EXPECT_EQ(Jobs({"delete", id, "--json"}).JsonLines().back()["deleted"], true);
  EXPECT_EQ(Jobs({"delete", id}).exit_code, 3);
}

TEST_F(JobsCommandTest, ResultWritesTheFilesAndNamesThem) {
  const std::string id = Ended(JobState::kSucceeded);
  jobs_.SetArtifacts(id, {{"manifest.json", artifacts_.Put("{}"), 2, "application/json"},
                          {"files/0.bin", artifacts_.Put("abc"), 3, ""}});
  TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  const PoiseRun run = Jobs({"result", id, "--out", out, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const base::Json files = run.JsonLines().back()["files"];
  ASSERT_THAT(files, SizeIs(2));
  EXPECT_EQ(std::filesystem::file_size(std::string(files[1]["file"])), 3u);
  const PoiseRun none = Jobs({"result", jobs_.Add(JobState::kRunning), "--out", out, "--json"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_EQ(none.Error()["reason"], "JOB_NOT_SUCCEEDED");
}

}  // namespace
}  // namespace poise::testing
