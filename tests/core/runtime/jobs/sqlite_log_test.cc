#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <thread>

#include "core/runtime/jobs/sqlite_job_store.h"
#include "tests/core/runtime/jobs/job_store_fixture.h"

// The log beside the file stays small, whoever reads.
namespace poise::testing {
namespace {

constexpr int64_t kMaxLogBytes = int64_t{24} << 20;

class SqliteLogTest : public ::testing::Test {
 protected:
  SqliteLogTest() {
    auto store = jobs::OpenSqliteJobStore({.path = folder_.path() / "jobs.db"});
    EXPECT_TRUE(store.ok()) << store.status();
    store_ = std::move(*store);
  }
  void Submit() {
    jobs::NewJob job;
    job.request.spec = {"selftest", {{"padding", std::string(8000, 'x')}}};
    EXPECT_TRUE(store_->Submit(job).ok());
  }
  int64_t log_bytes() { return store_->Stats()->wal_bytes; }

  const TemporaryFolder folder_;
  std::unique_ptr<jobs::JobStore> store_;
};

TEST_F(SqliteLogTest, StaysSmallWhileReadersNeverRest) {
  constexpr int kReaders = 8;
  constexpr int kWriters = 4;
  constexpr int kJobs = 1500;
  for (int i = 0; i < 200; ++i) Submit();
  std::atomic<int> left = kJobs;
  std::atomic<int64_t> most = 0;
  InParallel(kReaders + kWriters, [&](int i) {
    while (left > 0) {
      if (i < kReaders) {
        EXPECT_TRUE(store_->List({.page_size = 100}).ok());
      } else if (--left % 50 == 0) {
        most = std::max<int64_t>(most, log_bytes());
      } else {
        Submit();
      }
    }
  });
  EXPECT_LT(most, kMaxLogBytes);
}

TEST_F(SqliteLogTest, ShrinksAgainAfterSomebodyReadForLong) {
  SQLite::Database other((folder_.path() / "jobs.db").string());
  other.exec("BEGIN");
  other.execAndGet("SELECT count(*) FROM jobs");
  while (log_bytes() < 2 * kMaxLogBytes) Submit();  // goes on all the same
  other.exec("COMMIT");
  int more = 0;
  while (log_bytes() > kMaxLogBytes && ++more < 10'000) Submit();
  EXPECT_LT(log_bytes(), kMaxLogBytes);
}

}  // namespace
}  // namespace poise::testing
