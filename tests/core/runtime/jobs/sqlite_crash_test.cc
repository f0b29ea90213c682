#include <fmt/format.h>
#include <signal.h>

#include <sstream>

#include "core/base/random.h"
#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"
#include "tests/support/process.h"

// Real processes, really killed, between commit and answer and anywhere else.
namespace poise::testing {
namespace {

class SqliteCrashTest : public ::testing::Test {
 protected:
  std::string file() const { return (folder_.path() / "jobs.db").string(); }

  // Makes jobs in a process that ends at the fail-point; the request ids that it acknowledged.
  std::vector<std::string> SubmitUntilKilled(int count, const std::string& prefix,
                                             const std::string& fail_points) {
    Process child({POISE_JOB_STORE_CHILD, file(), std::to_string(count), prefix},
                  {{"POISE_FAIL_POINTS", fail_points}});
    EXPECT_EQ(child.Wait(), -SIGKILL) << child.ErrorOutput();
    std::istringstream lines(child.Output());
    std::vector<std::string> acknowledged;
    for (std::string line; std::getline(lines, line);) acknowledged.push_back(line);
    return acknowledged;
  }
  std::unique_ptr<jobs::JobStore> Open() {
    auto store = jobs::OpenSqliteJobStore({.path = file()});
    EXPECT_TRUE(store.ok()) << store.status();
    return store.ok() ? std::move(*store) : nullptr;
  }
  // Whether a job with this request id was there before.
  static bool IsKnown(jobs::JobStore& store, const std::string& request_id) {
    jobs::NewJob job;
    job.request.spec.kind = "selftest";
    job.request.request_id = request_id;
    const auto outcome = store.Submit(job);
    EXPECT_TRUE(outcome.ok()) << outcome.status();
    return outcome.ok() && !outcome->created;
  }

  const TemporaryFolder folder_;
};

TEST_F(SqliteCrashTest, KilledBetweenCommitAndAnswerTheRetryFindsTheJob) {
  const auto acknowledged = SubmitUntilKilled(10, "r", "store.after_commit=kill:3");
  EXPECT_EQ(acknowledged, (std::vector<std::string>{"r-0", "r-1"}));
  const auto store = Open();
  EXPECT_TRUE(IsKnown(*store, "r-2")) << "committed, and never answered";
  EXPECT_FALSE(IsKnown(*store, "r-3"));
  EXPECT_EQ(store->Stats()->submitted, 4);
}

TEST_F(SqliteCrashTest, KilledBeforeTheCommitTheRetryMakesTheJob) {
  const auto acknowledged = SubmitUntilKilled(10, "r", "store.before_commit=kill:3");
  EXPECT_EQ(acknowledged, (std::vector<std::string>{"r-0", "r-1"}));
  const auto store = Open();
  EXPECT_TRUE(IsKnown(*store, "r-1"));
  EXPECT_FALSE(IsKnown(*store, "r-2")) << "never committed, never answered";
}

TEST_F(SqliteCrashTest, KilledAtAnyCommitEveryAcknowledgedJobIsThereOnce) {
  constexpr int kRounds = 25;
  base::Random random(3);
  std::vector<std::string> acknowledged;
  for (int round = 0; round < kRounds; ++round) {
    const char* const point = random.Uniform() < 0.5 ? "store.after_commit" : "store.before_commit";
    const auto more = SubmitUntilKilled(100, fmt::format("round-{}", round),
                                        fmt::format("{}=kill:{}", point, 1 + random.Index(80)));
    acknowledged.insert(acknowledged.end(), more.begin(), more.end());
  }
  ASSERT_GT(acknowledged.size(), kRounds);
  const auto store = Open();
  const int64_t there = store->Stats()->submitted;
  EXPECT_GE(there, static_cast<int64_t>(acknowledged.size()));
  EXPECT_LE(there, static_cast<int64_t>(acknowledged.size()) + kRounds) << "one unanswered a round";
  for (const std::string& request_id : acknowledged) EXPECT_TRUE(IsKnown(*store, request_id));
  EXPECT_EQ(store->Stats()->submitted, there);
}

TEST_F(SqliteCrashTest, ASecondProcessIsRefusedUntilTheFirstIsKilled) {
  Process first({POISE_JOB_STORE_CHILD, file()});
  ASSERT_TRUE(first.WaitForOutput("open", absl::Seconds(30)));
  const auto refused = jobs::OpenSqliteJobStore({.path = file()}).status();
  EXPECT_EQ(ReasonOf(refused), "STORE_IN_USE");
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  Process second({POISE_JOB_STORE_CHILD, file()});
  EXPECT_EQ(second.Wait(), 2);
  EXPECT_EQ(second.Output(), "STORE_IN_USE\n");
  first.Signal(SIGKILL);
  first.Wait();
  EXPECT_NE(Open(), nullptr);
}

}  // namespace
}  // namespace poise::testing
