#include <SQLiteCpp/SQLiteCpp.h>

#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// Faults that were planted behind the store's back are found, each by its check.
namespace poise::testing {
namespace {

using ::testing::Contains;

struct Fault {
  const char* check;
  const char* sql;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.sql; }

constexpr Fault kFaults[] = {
    {"counts", "UPDATE tenants SET queued = queued + 1"},
    {"counts", "UPDATE tenants SET succeeded = succeeded - 1, failed = failed + 1"},
    {"counts", "UPDATE tenants SET submitted = submitted + 1"},
    {"counts", "UPDATE jobs SET state = 'FAILED' WHERE state = 'SUCCEEDED'"},
    {"counts", "DELETE FROM jobs WHERE state = 'QUEUED'"},
    {"counts", "UPDATE settings SET value = value + 1 WHERE name = 'events'"},
    {"leases", "DELETE FROM leases"},
    {"leases", "UPDATE leases SET attempt = 7"},
    {"leases",
     "INSERT INTO leases (job, attempt, token_hash, worker, expires_at, heartbeat_at) "
     "SELECT number, 1, 'x', 'w', 0, 0 FROM jobs WHERE state = 'SUCCEEDED'"},
    {"leases", "UPDATE attempts SET outcome = 'RUNNING' WHERE outcome = 'SUCCEEDED'"},
    {"events", "DELETE FROM events WHERE value = 'SUCCEEDED'"},
    {"events",
     "INSERT INTO events SELECT job, seq + 1, change + 1, type, time, attempt, value, error FROM "
     "events WHERE value = 'SUCCEEDED'"},
    {"events", "DELETE FROM events WHERE seq = 1"},
    {"integrity", "DELETE FROM specs"},
    {"integrity", "INSERT INTO inputs VALUES (999, 'artifacts/1')"},
    {"integrity", "UPDATE attempts SET job = 999 WHERE outcome = 'SUCCEEDED'"},
};

class SqliteDiagnoseTest : public ::testing::TestWithParam<Fault> {
 protected:
  StatusOr<std::unique_ptr<jobs::JobStore>> Open() {
    return jobs::OpenSqliteJobStore({.path = folder_.path() / "jobs.db"});
  }
  // One job of each sort: queued, running, succeeded.
  void MakeStore() {
    const auto store = Open();
    ASSERT_TRUE(store.ok()) << store.status();
    ASSERT_TRUE((*store)->UpsertWorker({.id = "w"}).ok());
    jobs::NewJob job;
    job.request.spec.kind = "selftest";
    for (int i = 0; i < 3; ++i) ASSERT_TRUE((*store)->Submit(job).ok());
    const auto done = *(*store)->Claim({"w", "1"});
    ASSERT_TRUE((*store)->Finish(done->fence, Success()).ok());
    ASSERT_TRUE((*store)->Claim({"w", "2"})->has_value());
  }
  std::vector<std::string> ChecksThatFound() {
    const auto store = Open();
    EXPECT_TRUE(store.ok()) << store.status();
    const auto findings = (*store)->Diagnose();
    EXPECT_TRUE(findings.ok()) << findings.status();
    std::vector<std::string> checks;
    for (const jobs::Finding& finding : *findings) {
      if (finding.severity == jobs::Finding::Severity::kFault) checks.push_back(finding.check);
    }
    return checks;
  }

  const TemporaryFolder folder_;
};

TEST_P(SqliteDiagnoseTest, FindsAPlantedFault) {
  MakeStore();
  EXPECT_THAT(ChecksThatFound(), ::testing::IsEmpty());
  SQLite::Database((folder_.path() / "jobs.db").string(), SQLite::OPEN_READWRITE)
      .exec(GetParam().sql);
  EXPECT_THAT(ChecksThatFound(), Contains(GetParam().check)) << GetParam().sql;
}

INSTANTIATE_TEST_SUITE_P(Faults, SqliteDiagnoseTest, ::testing::ValuesIn(kFaults));

}  // namespace
}  // namespace poise::testing
