// `poise jobs` and `poise admin` against a real poised with a worker of its own.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/client/cli/poise_program.h"

namespace poise::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class JobsEndToEndTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { server_ = new PoiseServer(/*workers=*/2); }
  static void TearDownTestSuite() { delete server_; }

  static std::string DataDir() { return server_->Path("data"); }
  static PoiseRun Poise(std::vector<std::string> arguments) {
    return server_->Poise(std::move(arguments));
  }
  // The last line of a command with --json.
  static base::Json Answer(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const PoiseRun run = Poise(std::move(arguments));
    return run.out.empty() ? base::Json() : run.JsonLines().back();
  }

  static PoiseServer* server_;
};

PoiseServer* JobsEndToEndTest::server_ = nullptr;

TEST_F(JobsEndToEndTest, AJobIsWaitedForAndItsFilesAreFetched) {
  const PoiseRun run = Poise({"jobs", "create", "selftest", "--param", "steps=20", "--param",
                              "artifacts=3", "--seed", "1", "--wait", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const base::Json job = run.JsonLines().back();
  EXPECT_EQ(job["state"], "SUCCEEDED");
  EXPECT_EQ(job["progress"]["step"], 20);
  EXPECT_EQ(job["attempts"][0]["outcome"], "SUCCEEDED");
  const std::string out = server_->Path("out");
  const base::Json result = Answer({"jobs", "result", job["name"], "--out", out});
  EXPECT_GE(result["files"].size(), 3u);
  for (const base::Json& file : result["files"]) {
    EXPECT_EQ(std::filesystem::file_size(std::string(file["file"])), file["size_bytes"]);
  }
  EXPECT_EQ(Poise({"jobs", "retry", job["name"]}).exit_code, 4) << "it did not fail";
  EXPECT_EQ(Answer({"jobs", "delete", job["name"]})["deleted"], true);
  EXPECT_EQ(Poise({"jobs", "get", job["name"]}).exit_code, 3);
}

TEST_F(JobsEndToEndTest, AJobThatFailsExitsWithEightAndCanBeTriedAgain) {
  const PoiseRun run = Poise({"jobs", "create", "selftest", "--param", "fail_at=3", "--param",
                              "failure=invalid", "--wait", "--json"});
  EXPECT_EQ(run.exit_code, 8);
  const base::Json job = run.JsonLines().back();
  EXPECT_EQ(job["state"], "FAILED");
  EXPECT_EQ(job["error"]["code"], "INVALID_ARGUMENT");
  const base::Json again = Answer({"jobs", "retry", job["name"], "--request-id", "again"});
  EXPECT_EQ(again["retry_of"], job["name"]);
  EXPECT_EQ(Answer({"jobs", "retry", job["name"], "--request-id", "again"})["name"], again["name"]);
  const PoiseRun text = Poise({"jobs", "get", job["name"]});
  EXPECT_THAT(text.out, HasSubstr("FAILED"));
}

TEST_F(JobsEndToEndTest, WatchTellsEveryStateAndProgressWithRisingNumbers) {
  const base::Json job =
      Answer({"jobs", "create", "selftest", "--param", "steps=40", "--param", "step_ms=50"});
  const PoiseRun run = Poise({"jobs", "watch", job["name"], "--json"});
  EXPECT_EQ(run.exit_code, 0);
  std::vector<std::string> states;
  int64_t seq = 0;
  int64_t step = 0;
  for (const base::Json& event : run.JsonLines()) {
    EXPECT_GT(event["seq"], seq);
    seq = event["seq"];
    if (event.contains("state")) states.push_back(event["state"]);
    if (event.contains("progress")) step = event["progress"]["step"];
  }
  EXPECT_THAT(states, ::testing::ElementsAre("QUEUED", "RUNNING", "SUCCEEDED"));
  EXPECT_GT(step, 0);
}

TEST_F(JobsEndToEndTest, ARunningJobIsCancelled) {
  const base::Json job = Answer({"jobs", "create", "selftest", "--param", "steps=100000"});
  while (Answer({"jobs", "get", job["name"]})["state"] == "QUEUED") {
  }
  const PoiseRun run = Poise({"jobs", "cancel", job["name"], "--wait", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.JsonLines().back()["state"], "CANCELLED");
  EXPECT_EQ(Poise({"jobs", "watch", job["name"]}).exit_code, 6);
}

TEST_F(JobsEndToEndTest, MistakesAreTheServersWithReasonAndField) {
  const base::Json kind = Answer({"jobs", "create", "selftst"});
  EXPECT_EQ(kind["error"]["reason"], "UNKNOWN_JOB_KIND");
  const PoiseRun run = Poise({"jobs", "create", "selftest", "--param", "stps=1", "--json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(std::string(run.Error()["message"]), HasSubstr("steps"));
  Answer({"jobs", "create", "selftest", "--request-id", "used"});
  const base::Json reused =
      Answer({"jobs", "create", "selftest", "--seed", "2", "--request-id", "used"});
  EXPECT_EQ(reused["error"]["reason"], "REQUEST_ID_REUSED");
}

TEST_F(JobsEndToEndTest, TenantsDoNotSeeEachOthersJobs) {
  const base::Json job = Answer({"jobs", "create", "selftest", "--tenant", "a"});
  EXPECT_EQ(Answer({"jobs", "get", job["name"], "--tenant", "a"})["name"], job["name"]);
  EXPECT_EQ(Poise({"jobs", "get", job["name"], "--tenant", "b"}).exit_code, 3);
  EXPECT_THAT(Poise({"jobs", "list", "--tenant", "b", "--json"}).out, IsEmpty());
}

TEST_F(JobsEndToEndTest, OperatorsCheckAndCopyTheStore) {
  const PoiseRun doctor = Poise({"admin", "doctor", "--json"});
  EXPECT_EQ(doctor.exit_code, 0) << doctor.out;
  EXPECT_THAT(doctor.JsonLines().back()["findings"], Not(IsEmpty()));
  const base::Json backup = Answer({"admin", "backup", "backups/one.db"});
  EXPECT_EQ(backup["path"], DataDir() + "/backups/one.db");
  EXPECT_EQ(std::filesystem::file_size(std::string(backup["path"])), backup["size_bytes"]);
  EXPECT_EQ(Poise({"admin", "backup", "backups/one.db"}).exit_code, 4) << "it is there";
}

}  // namespace
}  // namespace poise::testing
